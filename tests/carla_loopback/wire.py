"""The bytes of CARLA 0.9.16's wire, as far as its client was seen to read them. All angles [deg], left-handed."""

from __future__ import annotations

import struct
from typing import Any

from tests.carla_loopback.bodies import Body, Kind

VERSION = "0.9.16"
WORLD_STATE, COLLISION = 17, 0  # sensor types
WORLD_STREAM = 1  # stream id

_HEADER = struct.Struct("<QQd6f")  # sensor type, frame, time [s], transform
_STATE = struct.Struct("<Qdf3iI")  # episode, wall clock [s], dt [s], origin, flags
_BODY = struct.Struct("<IB15f54s")  # id, state, transform, velocity, angular velocity, acceleration, union
_VEHICLE = struct.Struct("<3f3?ifB?IB")
_LIGHT = struct.Struct("<32s4f?IB")
_TOKEN = struct.Struct("<IHBB16s")
TCP, V4 = 1, 1
ACTIVE = 1


def value(result: object) -> list[Any]:
    return [[1, result]]


def error(message: str) -> list[Any]:
    return [[0, [message]]]


def void() -> list[Any]:
    return [[False]]


def optional(result: object) -> list[Any]:
    return [False] if result is None else [True, result]


def token(stream: int, port: int) -> bytes:
    """Return where a stream is to be had: on this machine."""
    return _TOKEN.pack(stream, port, TCP, V4, bytes([127, 0, 0, 1]))


def transform(body: Body) -> list[Any]:
    return [[body.x, body.y, body.z], [body.pitch, body.yaw, body.roll]]


def actor(body: Body, port: int) -> list[Any]:
    """Return what the client keeps of an actor."""
    stream = token(body.id, port) if body.kind is Kind.SENSOR else b""
    tags = bytes([14]) if body.kind is Kind.VEHICLE else b""
    return [body.id, body.parent, list(body.description), bounding_box(body), tags, stream]


def bounding_box(body: Body) -> list[Any]:
    location, extent = list(body.box_centre), list(body.extent)
    return [location, extent, [0.0, 0.0, 0.0], body.id]


def physics(max_steer: float) -> list[Any]:
    """Return what the client is told of a vehicle's engine and wheels; of this only the steering angles are used."""
    wheel = [3.5, 0.25, max_steer, 35.0, 1500.0, 3000.0, 2.0, 17.0, 1000.0, [0.0, 0.0, 0.0]]
    gears = [[4.0, 0.5, 0.65]]
    curve = [[0.0, 1.0], [120.0, 1.0]]
    engine = [[[0.0, 400.0]], 5800.0, 1.0, 0.15, 2.0, 0.35, True, 0.5, 10.0, 4.0]
    return [*engine, gears, 1850.0, 0.3, [0.0, 0.0, 0.0], curve, [wheel] * 4, False]


def world_state(frame: int, episode: int, time: float, dt: float, bodies: list[Body]) -> bytes:
    """Return one snapshot of the world."""
    header = _HEADER.pack(WORLD_STATE, frame, time, *[0.0] * 6)
    parts = [header, _STATE.pack(episode, time, dt, 0, 0, 0, 0)]
    parts += [
        _BODY.pack(
            body.id, ACTIVE, body.x, body.y, body.z, body.pitch, body.yaw, body.roll, *body.velocity,
            0.0, 0.0, body.yaw_rate, *body.acceleration, _union(body),
        )
        for body in bodies
    ]  # fmt: skip
    return b"".join(parts)


def collision_header(frame: int, time: float, body: Body) -> bytes:
    place = (body.x, body.y, body.z, body.pitch, body.yaw, body.roll)
    return _HEADER.pack(COLLISION, frame, time, *place)


def _union(body: Body) -> bytes:
    if body.kind is Kind.VEHICLE:
        throttle, steer, brake, hand, reverse, manual, gear = body.control
        at_light, light, state = body.at_light is not None, body.at_light or 0, body.light_state
        return _VEHICLE.pack(
            throttle, steer, brake, hand, reverse, manual, gear, body.speed_limit, state, at_light, light, 0
        )
    if body.kind is Kind.LIGHT:
        return _LIGHT.pack(body.sign.encode(), 10.0, 3.0, 2.0, 0.0, False, 0, body.light_state)
    return b""
