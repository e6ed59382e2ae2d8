"""A CARLA server: its version, maps and settings, the one place that ticks, and how it is left."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Iterable
from contextlib import nullcontext
from typing import Any

import carla

from tmpud.errors import SimulatorError
from tmpud.geometry import Point, Pose
from tmpud.roads.carla_coordinates import from_pose
from tmpud.simulators.carla.waking import Waker
from tmpud.simulators.conventions import DT

CONNECTED = 2.5  # [s] in which a server says its version
LOADING = 60.0  # [s] in which a server loads a map
LIFT = 0.5  # [m] a car is put so much above the road, and falls onto it
ROLE = "tmpud"  # role names of all our actors begin so
KEPT = ("no_rendering_mode", "max_substep_delta_time", "max_substeps", "substepping", "deterministic_ragdolls")


class Server:
    """One connection. It is refused where the server's version is not the client's, of which CARLA only warns."""

    def __init__(self, client: Any, patience: float) -> None:
        self.client, self._patience = client, patience
        client.set_timeout(min(patience, CONNECTED))
        self.version = str(client.get_server_version())
        own = importlib.metadata.version("carla")
        if self.version != own:
            raise SimulatorError(
                f"the server is CARLA {self.version}, the client {own}: pip install 'carla=={self.version}'"
            )
        self.world = client.get_world()
        client.set_timeout(patience)
        self.found = self.settings()  # what to leave behind
        self.ours: set[int] = set()  # ids of our actors
        self._taken = False  # whether there is anything to put back
        self._frame = 0  # the last
        self.waker: Waker | None = None  # while a Traffic Manager takes part in ticks

    def load(self, name: str) -> None:
        """Load a map anew: no actors of anybody's, the clock at 0, and step by step from here on."""
        self._taken = True
        self.world = self._loaded(name)
        settings = self.world.get_settings()
        settings.no_rendering_mode = self.found["no_rendering_mode"]
        settings.synchronous_mode, settings.fixed_delta_seconds = True, DT
        self.world.apply_settings(settings)
        self.world.reset_all_traffic_lights()
        self.tick()
        loaded = _short(self.world.get_map().name)
        if loaded != _short(name):
            raise SimulatorError(f"asked for the map {name}, the server shows {loaded}")

    def map_text(self, name: str) -> str:
        """Return a map as OpenDRIVE."""
        if _short(self.world.get_map().name) != _short(name):
            self.world = self._loaded(name)
        return str(self.world.get_map().to_opendrive())

    def _loaded(self, name: str) -> Any:
        maps = sorted({_short(known) for known in self.client.get_available_maps()})
        if _short(name) not in maps:
            raise SimulatorError(f"the server has no map {name}; it has {', '.join(maps)}")
        self.client.set_timeout(LOADING)
        try:
            return self.client.load_world(name, reset_settings=True)
        finally:
            self.client.set_timeout(self._patience)

    def tick(self) -> Any:
        """Take one step and return the snapshot of it: the only place that ticks, and the only one that reads it."""
        with self.waker.watching(self._ticked) if self.waker else nullcontext():
            frame = self.world.tick(self._patience)
        self._frame = frame
        snapshot = self.world.get_snapshot()
        if snapshot.frame != frame:
            raise RuntimeError(f"ticked to frame {frame}, the world shows frame {snapshot.frame}")
        return snapshot

    def _ticked(self) -> bool:
        """Return whether the world has gone on since the last step; for the waker's thread."""
        return bool(self.world.get_snapshot().frame > self._frame)

    def destroy(self, ids: Iterable[int]) -> None:
        """Take actors of ours away."""
        gone = sorted(self.ours.intersection(ids))
        self.client.apply_batch_sync([carla.command.DestroyActor(actor) for actor in gone], False)
        self.ours.difference_update(gone)

    def settings(self) -> dict[str, Any]:
        """Return what of the settings is put back in the end."""
        settings = self.world.get_settings()
        return {name: getattr(settings, name) for name in (*KEPT, "synchronous_mode", "fixed_delta_seconds")}

    def left_behind(self) -> int:
        """Return how many actors of our roles there are on a server that runs freely."""
        if not self.settings()["synchronous_mode"]:
            self.world.wait_for_tick(self._patience)  # before it, no actor is known
        return len(self._of_our_roles())

    def leave(self) -> int:
        """Remove our actors, restore the settings found, and return how many of our actors are left."""
        gone, left = set(self.ours), 0
        if gone:
            self.destroy(gone)
            left = sum(actor.id in gone for actor in self.tick())
        if self._taken:
            self._restore(self.found)
        return left

    def sweep(self, found: dict[str, Any]) -> int:
        """Remove what a client that died left: restore the settings that it had found, remove actors of our roles."""
        self._restore(found)
        self.world.wait_for_tick(self._patience)  # before it, no actor is known
        gone = self._of_our_roles()
        self.ours = set(gone)
        self.destroy(gone)
        self.world.wait_for_tick(self._patience)
        return len(self._of_our_roles())

    def _of_our_roles(self) -> list[int]:
        actors = self.world.get_actors()
        return [actor.id for actor in actors if actor.attributes.get("role_name", "").startswith(ROLE)]

    def _restore(self, words: dict[str, Any]) -> None:
        """Put settings back, but leave no server waiting for ticks: one found so was left so by a client that died."""
        settings = self.world.get_settings()
        for name in KEPT:
            setattr(settings, name, words[name])
        step = None if words["synchronous_mode"] else words["fixed_delta_seconds"]
        settings.synchronous_mode, settings.fixed_delta_seconds = False, step
        self.world.apply_settings(settings)


def _short(name: str) -> str:
    """Return a map's name without its folders."""
    return name.rsplit("/", 1)[-1]


def above(server: Server, pose: Pose, box: Point = (0.0, 0.0)) -> Any:
    """Return where an actor is put such that the centre of its box is a little above a pose on the road."""
    x, y, yaw = from_pose(pose, box)
    road = server.world.get_map().get_waypoint(carla.Location(x, y, 0.0))
    z = road.transform.location.z if road else 0.0
    return carla.Transform(carla.Location(x, y, z + LIFT), carla.Rotation(yaw=yaw))
