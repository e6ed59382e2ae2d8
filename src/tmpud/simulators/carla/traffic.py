"""Circulating traffic on a CARLA server, driven by the Traffic Manager, which runs in this process."""

from __future__ import annotations

import math
import random
import socket
from typing import Any

import carla

from tmpud.errors import SimulatorError
from tmpud.geometry import Point, Pose
from tmpud.roads.carla_coordinates import KMH, to_point
from tmpud.simulators.carla.server import ROLE, Server, above
from tmpud.simulators.carla.waking import Waker
from tmpud.simulators.conventions import SENSING_RANGE

ROOM = 10.0  # [m] around a spawn point where a car appears


class Traffic:
    """Cars that drive for ever. Those that the Traffic Manager or the server takes away come back elsewhere."""

    def __init__(self, server: Server, rng: random.Random, seed: int, rules: dict[str, float]) -> None:
        self._server, self._rng, self._rules = server, rng, rules
        self._port = _free_port()
        self._manager = server.client.get_trafficmanager(self._port)
        self._manager.set_synchronous_mode(True)  # this and the seed before any car is registered
        self._manager.set_random_device_seed(seed % 2**31)
        self._manager.set_hybrid_physics_mode(False)
        self._manager.set_global_distance_to_leading_vehicle(rules["min_gap"])
        server.waker = Waker(self._port)
        self._points = list(server.world.get_map().get_spawn_points())
        self._models = _cars(server.world.get_blueprint_library())
        self._ids: set[int] = set()

    def fill(self, count: int) -> None:
        """Put cars on the road; SimulatorError where there is no room for so many."""
        points = list(self._points)
        self._rng.shuffle(points)
        while len(self._ids) < count and points:
            wanted = count - len(self._ids)
            self._spawn(points[:wanted])
            del points[:wanted]
        if len(self._ids) < count:
            raise SimulatorError(f"the server took {len(self._ids)} of {count} vehicles: the map has no room for more")

    def keep(self, snapshot: Any, ego: Point | None) -> None:
        """Look who is there, and let a car come back for each that is not."""
        present = {actor.id: actor for actor in snapshot}
        missing = sorted(self._ids - present.keys())
        if not missing:
            return
        self._forget(missing)
        places = [to_point(p.x, p.y) for actor in present.values() if (p := actor.get_transform().location)]
        self._return(len(missing), places, ego)

    def move(self, ids: list[int], snapshot: Any, ego: Point) -> None:
        """Take cars away; as many come back out of sight."""
        self._server.destroy(self._ids.intersection(ids))
        there = {actor.id: actor for actor in snapshot if actor.id not in ids}
        self.keep(list(there.values()), ego)

    def _forget(self, ids: list[int]) -> None:
        self._ids.difference_update(ids)
        self._server.ours.difference_update(ids)

    def _return(self, count: int, taken: list[Point], ego: Point | None) -> None:
        """Spawn some cars where nobody is near and the ego does not see it, as far as there is room."""
        points = list(self._points)
        self._rng.shuffle(points)
        free = []
        for point in points:
            place = to_point(point.location.x, point.location.y)
            seen = ego is not None and math.dist(place, ego) < SENSING_RANGE  # no car appears in the ego's sight
            if not seen and all(math.dist(place, other) > ROOM for other in taken):
                free.append(point)
                taken.append(place)
            if len(free) == count:
                break
        self._spawn(free)

    def _spawn(self, points: list[Any]) -> None:
        spawn, drive, anyone = carla.command.SpawnActor, carla.command.SetAutopilot, carla.command.FutureActor
        batch = [spawn(self._model(), point).then(drive(anyone, True, self._port)) for point in points]
        replies = self._server.client.apply_batch_sync(batch, False)
        born = [reply.actor_id for reply in replies if not reply.error]
        self._server.ours.update(born)
        self._ids.update(born)
        for actor in self._server.world.get_actors(born):
            spread = self._rng.uniform(1 - self._rules["spread"], 1 + self._rules["spread"])
            self._manager.set_desired_speed(actor, self._rules["speed"] * spread * KMH)

    def _model(self) -> Any:
        model = self._rng.choice(self._models)
        model.set_attribute("role_name", f"{ROLE} traffic")
        return model

    def park(self, pose: Pose) -> None:
        """Put a car at a pose without driver; SimulatorError where the server refuses it."""
        actor = self._server.world.try_spawn_actor(self._model(), above(self._server, pose))
        if actor is None:
            raise SimulatorError(f"the server does not spawn a car at {pose.x:.1f}, {pose.y:.1f}")
        self._server.ours.add(actor.id)
        actor.apply_control(carla.VehicleControl(hand_brake=True))

    def end(self) -> None:
        """End the Traffic Manager, before its cars are gone: else it looks for them and aborts.

        Without an end the next session would hang or crash.
        """
        if self._server.waker:
            self._server.waker.end()
            self._server.waker = None
        self._manager.set_synchronous_mode(False)
        self._manager.shut_down()


def _cars(library: Any) -> list[Any]:
    """Return the blueprints of cars, in the order of their names: that of the library may be any."""
    models = [model for model in library.filter("vehicle.*") if int(model.get_attribute("number_of_wheels")) == 4]
    cars = [m for m in models if not m.has_attribute("base_type") or m.get_attribute("base_type").as_str() == "car"]
    return sorted(cars, key=lambda model: str(model.id))


def _free_port() -> int:
    with socket.create_server(("", 0)) as taken:
        port: int = taken.getsockname()[1]
        return port
