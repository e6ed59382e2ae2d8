"""What is in the loopback server's world, and how its vehicles move: kinematic bicycles, no forces, no contacts."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

WHEELBASE = 2.9  # [m]
MAX_STEER = 70.0  # [deg] of the front wheels at steer = 1
PULL, BRAKES, DRAG = 5.0, 9.0, 0.1  # [m/s^2] at full throttle and at full brake, [1/s] of the speed
Triple = tuple[float, float, float]
Control = tuple[float, float, float, bool, bool, bool, int]  # throttle, steer, brake, hand, reverse, manual, gear


class Kind(Enum):
    VEHICLE = "vehicle"
    LIGHT = "traffic light"
    SENSOR = "sensor"


@dataclass(slots=True)
class Body:
    """One actor. Left-handed: yaw and steer grow to the right."""

    id: int
    kind: Kind
    description: tuple[Any, ...]
    x: float = 0.0  # [m]
    y: float = 0.0
    z: float = 0.0
    pitch: float = 0.0  # [deg]
    yaw: float = 0.0
    roll: float = 0.0
    parent: int = 0
    extent: Triple = (0.0, 0.0, 0.0)  # [m] half of the box's size
    box_centre: Triple = (0.0, 0.0, 0.0)  # [m] from the actor's origin
    speed: float = 0.0  # [m/s]
    velocity: Triple = (0.0, 0.0, 0.0)
    acceleration: Triple = (0.0, 0.0, 0.0)
    yaw_rate: float = 0.0  # [deg/s]
    control: Control = (0.0, 0.0, 0.0, False, False, False, 0)
    speed_limit: float = 30.0  # [km/h]
    at_light: int | None = None  # id of the light whose box it is in
    light_state: int = 0  # 0 red, 1 yellow, 2 green; of a vehicle, what its light shows
    sign: str = ""  # a light's id in the map
    place: Any = field(default=None)  # of a light: where it holds vehicles up


def place(body: Body, transform: list[Any]) -> None:
    """Put a body somewhere; spawned on lifted points, it is on the ground at once."""
    (body.x, body.y, _), (body.pitch, body.yaw, body.roll) = transform


def drive(body: Body, dt: float, *, mirrored: bool = False) -> None:
    """Move a vehicle by its control: a bicycle that turns about its rear axle, half a wheelbase behind its origin."""
    throttle, steer, brake, hand = body.control[:4]
    pull = max(min(throttle, 1.0), 0.0) * PULL - DRAG * body.speed
    braking = BRAKES * max(min(brake, 1.0), 0.0) + (BRAKES if hand else 0.0)
    before = body.speed
    body.speed = max(before + (pull - braking) * dt, 0.0)
    angle = math.radians(MAX_STEER * max(min(steer, 1.0), -1.0)) * (-1 if mirrored else 1)
    turned = (before + body.speed) / 2 * dt * math.tan(angle) / WHEELBASE
    yaw = math.radians(body.yaw)
    along = (before + body.speed) / 2 * dt
    half = WHEELBASE / 2
    x, y = body.x, body.y
    body.x += along * math.cos(yaw + turned / 2) + half * (math.cos(yaw + turned) - math.cos(yaw))
    body.y += along * math.sin(yaw + turned / 2) + half * (math.sin(yaw + turned) - math.sin(yaw))
    body.yaw += math.degrees(turned)
    body.yaw_rate = math.degrees(turned) / dt
    body.velocity = ((body.x - x) / dt, (body.y - y) / dt, 0.0)
    rate = (body.speed - before) / dt
    body.acceleration = (rate * math.cos(yaw), rate * math.sin(yaw), 0.0)


def near(one: Body, other: Body) -> bool:
    """Whether two boxes overlap, by three circles each."""
    return any(math.hypot(a - c, b - d) < 2.0 for a, b in _spots(one) for c, d in _spots(other))


def _spots(body: Body) -> list[tuple[float, float]]:
    yaw, reach = math.radians(body.yaw), max(body.extent[0] - 1.0, 0.0)
    return [(body.x + s * math.cos(yaw), body.y + s * math.sin(yaw)) for s in (-reach, 0.0, reach)]
