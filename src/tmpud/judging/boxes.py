"""Overlap of oriented boxes by separating axes: one box against N vehicles at once."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.scene import Vehicles, VehicleState


class Box(NamedTuple):
    """A rectangle given by its centre [m], its heading [rad] and its size [m]."""

    x: float
    y: float
    heading: float
    length: float
    width: float


def box_of(vehicle: VehicleState) -> Box:
    return Box(*vehicle.pose, vehicle.length, vehicle.width)


def part_of(box: Box, depth: float, front: bool) -> Box:
    """Return the foremost or rearmost ``depth`` metres of a box."""
    shift = (box.length - depth) / 2 * (1.0 if front else -1.0)
    x, y = box.x + shift * math.cos(box.heading), box.y + shift * math.sin(box.heading)
    return Box(x, y, box.heading, depth, box.width)


def overlapping(box: Box, others: Vehicles) -> NDArray[np.intp]:
    """Return the indices of the vehicles whose boxes overlap a box, seen from above; touching counts."""
    reach = (math.hypot(box.length, box.width) + np.hypot(others.length, others.width)) / 2
    near = np.flatnonzero(np.hypot(others.x - box.x, others.y - box.y) <= reach)
    return near[_overlap(box, others, near)] if near.size else near


def _overlap(box: Box, others: Vehicles, near: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether no side of either box separates the two, for each of the K vehicles ``near``."""
    dx, dy = others.x[near] - box.x, others.y[near] - box.y
    length, width, heading = others.length[near], others.width[near], others.heading[near]
    cos, sin = np.abs(np.cos(heading - box.heading)), np.abs(np.sin(heading - box.heading))
    own_x, own_y = math.cos(box.heading), math.sin(box.heading)
    their_x, their_y = np.cos(heading), np.sin(heading)
    return np.asarray(
        (np.abs(dx * own_x + dy * own_y) * 2 <= box.length + cos * length + sin * width)
        & (np.abs(dy * own_x - dx * own_y) * 2 <= box.width + sin * length + cos * width)
        & (np.abs(dx * their_x + dy * their_y) * 2 <= length + cos * box.length + sin * box.width)
        & (np.abs(dy * their_x - dx * their_y) * 2 <= width + sin * box.length + cos * box.width)
    )
