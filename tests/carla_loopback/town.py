"""The loopback server's world: actors, settings, clock, and what happens in a tick."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from tests.carla_loopback.blueprints import EXTENTS
from tests.carla_loopback.bodies import Body, Kind, drive, near, place
from tests.carla_loopback.faults import Faults
from tests.carla_loopback.lights import Light, look, place_lights

FREE_DT = 0.05  # [s] of a tick where the client does not say
SYNC, NO_RENDERING, STEP = range(3)  # places in the settings


def default_settings() -> list[Any]:
    """Return what a server starts with: not synchronous, steps of any length."""
    return [False, False, [False], True, 0.01, 10, 0.0, False, 3000.0, 2000.0, True]


@dataclass(slots=True)
class Town:
    """One episode at a time; loading a map begins the next."""

    map_name: str
    xodr: str
    spawn_points: list[Any]
    light_places: list[Light]
    faults: Faults
    episode: int = 1
    frame: int = 100
    time: float = 7.0  # [s] since the episode began
    settings: list[Any] = field(default_factory=default_settings)
    settings_seen: list[list[Any]] = field(default_factory=list)
    bodies: dict[int, Body] = field(default_factory=dict)
    collisions: list[tuple[Body, Body, Body]] = field(default_factory=list)  # sensor, its vehicle, the other
    last_id: int = 20

    def __post_init__(self) -> None:
        self.bodies.update((light.id, light) for light in place_lights(self.light_places, self.new_id))

    def new_id(self) -> int:
        self.last_id += 1
        return self.last_id

    @property
    def dt(self) -> float:
        """Return the length of a tick [s]."""
        step = self.settings[STEP]
        return float(step[1]) if step[0] and step[1] else FREE_DT

    def load(self, *, reset_settings: bool) -> None:
        """Begin the next episode: without actors, its clock at 0."""
        self.bodies.clear()
        self.episode += 1
        self.time = 0.0
        if reset_settings:
            self.settings = default_settings()
        self.__post_init__()

    def spawn(self, description: list[Any], transform: list[Any], parent: int = 0) -> Body | str:
        """Return the new actor, or why there is none."""
        name = description[1]
        kind = Kind.VEHICLE if name in EXTENTS else Kind.SENSOR
        body = Body(self.last_id + 1, kind, tuple(description), parent=parent)
        place(body, transform)
        if kind is Kind.VEHICLE:
            body.extent, body.box_centre = EXTENTS[name], (0.05, 0.0, EXTENTS[name][2])
            if self.faults.refuses_spawn() or any(near(body, other) for other in self.vehicles()):
                return "Spawn failed because of collision at spawn position"
        self.bodies[self.new_id()] = body
        return body

    def park(self, x: float, y: float, yaw: float) -> int:
        """Put a car there that nobody drives and none of the clients knows of."""
        body = Body(self.new_id(), Kind.VEHICLE, (1, "vehicle.audi.a2", []), x, y, yaw=yaw)
        body.extent, body.box_centre = EXTENTS["vehicle.audi.a2"], (0.05, 0.0, 0.77)
        self.bodies[body.id] = body
        return body.id

    def vehicles(self) -> list[Body]:
        return [body for body in self.bodies.values() if body.kind is Kind.VEHICLE]

    def destroy(self, actor: int) -> bool:
        return self.faults.keeps_actors or self.bodies.pop(actor, None) is not None

    def tick(self) -> None:
        """Move everything by one step."""
        self.frame += 1
        self.time += self.dt
        lights = [body for body in self.bodies.values() if body.kind is Kind.LIGHT]
        look(lights, self.vehicles(), self.time)
        for body in self.vehicles():
            drive(body, self.dt, mirrored=self.faults.mirrored)
        for actor in self.faults.vanishing(self.frame, [body.id for body in self.vehicles()]):
            self.bodies.pop(actor)
        self.collisions = self._collisions()

    def _collisions(self) -> list[tuple[Body, Body, Body]]:
        sensors = [body for body in self.bodies.values() if body.kind is Kind.SENSOR and body.parent in self.bodies]
        found = []
        for sensor in sensors:
            owner = self.bodies[sensor.parent]
            found += [(sensor, owner, other) for other in self.vehicles() if other is not owner and near(owner, other)]
        return found

    def report(self) -> dict[str, Any]:
        """Return what a test wants to know of the server."""
        kinds = Counter(body.kind.value for body in self.bodies.values())
        return {
            "frame": self.frame,
            "settings": self.settings,
            "settings_seen": self.settings_seen,
            "actors": dict(kinds),
            "vehicles": {body.id: [body.x, body.y, body.yaw, body.speed] for body in self.vehicles()},
        }
