"""The few blueprints of the loopback server, with the attributes that the client and its Traffic Manager ask for."""

from __future__ import annotations

from typing import Any

BOOL, INT, FLOAT, STRING, COLOR = range(1, 6)
CARS = {
    "vehicle.tesla.model3": (2.4, 1.08, 0.74),
    "vehicle.audi.a2": (1.85, 0.89, 0.77),
    "vehicle.nissan.micra": (1.82, 0.92, 0.75),
}  # -> half of the box's size [m]
BIKE = {"vehicle.bh.crossbike": (0.74, 0.43, 0.53)}
EXTENTS = CARS | BIKE
COLLISION = "sensor.other.collision"


def definitions() -> list[Any]:
    """Return all blueprints in the form of ``get_actor_definitions``."""
    ids = [*EXTENTS, COLLISION]
    return [[uid, name, name.replace(".", ","), _attributes(name)] for uid, name in enumerate(ids, 1)]


def _attributes(name: str) -> list[Any]:
    common = [_attribute("role_name", STRING, "default", ("autopilot", "hero"))]
    if name not in EXTENTS:
        return common
    wheels = "4" if name in CARS else "2"
    return [
        *common,
        _attribute("color", COLOR, "17,37,103", ("17,37,103", "180,44,44")),
        _attribute("number_of_wheels", INT, wheels, modifiable=False),
        _attribute("base_type", STRING, "car" if name in CARS else "bicycle", modifiable=False),
        _attribute("has_lights", BOOL, "true", modifiable=False),
        _attribute("sticky_control", BOOL, "true"),
    ]


def _attribute(
    name: str, kind: int, value: str, recommended: tuple[str, ...] = (), *, modifiable: bool = True
) -> list[Any]:
    return [name, kind, value, list(recommended), modifiable, False]
