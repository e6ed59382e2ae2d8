"""One snapshot of CARLA's world as rows of numbers in our coordinates."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from tmpud.roads.carla_coordinates import to_point, to_pose, to_yaw_rate
from tmpud.scene import FloatArray
from tmpud.simulators.carla.messages import COLUMNS

VEHICLE = "vehicle."


class Box(NamedTuple):
    """A vehicle's box, which never changes; asking for it is a call over the wire."""

    centre: tuple[float, float]  # [m] ahead and to the right of the actor's origin
    length: float  # [m]
    width: float


class Reader:
    """Reads vehicles, whoever put them there."""

    def __init__(self, world: Any) -> None:
        self._world = world
        self._boxes: dict[int, Box | None] = {}  # None: not a vehicle

    def read(self, snapshot: Any, ego: int | None) -> tuple[list[int], FloatArray]:
        """Return ids and rows (N, COLUMNS), the ego's first where it is there, then in the order of ids."""
        rows = {actor.id: self._row(actor, box) for actor in snapshot if (box := self._box(actor.id))}
        ids = sorted(rows, key=lambda actor: (actor != ego, actor))
        return ids, np.array([rows[actor] for actor in ids], dtype=np.float64).reshape(-1, COLUMNS)

    def _box(self, actor: int) -> Box | None:
        if actor not in self._boxes:
            known = self._world.get_actor(actor)
            self._boxes[actor] = box_of(known) if known and known.type_id.startswith(VEHICLE) else None
        return self._boxes[actor]

    def _row(self, actor: Any, box: Box) -> tuple[float, ...]:
        place, velocity, change = actor.get_transform(), actor.get_velocity(), actor.get_acceleration()
        location = place.location
        pose = to_pose(location.x, location.y, place.rotation.yaw, box.centre)
        cos, sin = math.cos(pose.heading), math.sin(pose.heading)
        vx, vy = to_point(velocity.x, velocity.y)
        ax, ay = to_point(change.x, change.y)
        yaw_rate = to_yaw_rate(actor.get_angular_velocity().z)
        return (*pose[:2], location.z, pose.heading, vx * cos + vy * sin, yaw_rate, ax * cos + ay * sin, *box[1:])


def box_of(actor: Any) -> Box:
    """Return an actor's box; of some two-wheelers CARLA says that it has no width."""
    box = actor.bounding_box
    return Box((box.location.x, box.location.y), max(2 * box.extent.x, 0.5), max(2 * box.extent.y, 0.5))
