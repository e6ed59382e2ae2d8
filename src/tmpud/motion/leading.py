"""Who is followed: the nearest vehicle ahead whose box reaches into the ego's way."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tmpud.geometry import Pose
from tmpud.motion.route import SPACING, Route
from tmpud.scene import FloatArray, Scene, Vehicles

LOOK_AHEAD = 50.0  # [m]
SAME_LEVEL = 3.0  # [m]
SIDE_ROOM = 0.25  # [m] kept free beside the ego
LENGTHWAYS = np.array([1, 1, 1, 0, 0, -1, -1, -1]) / 2  # eight points on a box's rim, as shares of its length ...
SIDEWAYS = np.array([1, 0, -1, 1, -1, 1, 0, -1]) / 2  # ... and of its width


class Obstacle(NamedTuple):
    """Something ahead on the route that must not be reached."""

    gap: float  # [m] from the ego's front bumper
    speed: float  # [m/s] along the route


def leader(scene: Scene, route: Route, station: float) -> Obstacle | None:
    """Return the nearest vehicle ahead whose box reaches into the ego's way, within LOOK_AHEAD metres."""
    ego, others = scene.ego, scene.others
    first, last = route.index(station), route.index(station + LOOK_AHEAD + ego.length) + 1
    near = _near(scene, route.poses[first:last])
    if not near:
        return None
    along, across, angle = _beside(route, first, last, *_rims(others, near))
    reach = ego.width / 2 + SIDE_ROOM
    boxes = zip(along.tolist(), across.tolist(), strict=True)
    begin = station - first * SPACING
    rears = ((_rear(box, reach), i) for i, box in enumerate(boxes) if max(box[0]) > begin)
    rear, i = min(rears, default=(math.inf, 0))
    gap = rear - begin - ego.length / 2
    if gap > LOOK_AHEAD:
        return None
    speed = float(others.speed[near[i]] * np.cos(others.heading[near[i]] - angle[i]))
    return Obstacle(gap, max(speed, 0.0))


def _rear(box: tuple[list[float], list[float]], reach: float) -> float:
    """Return how far along the route a box begins to reach into the way [m]; inf where it keeps off.

    The box is how far along the route and to its left the points of its rim are.
    """
    along, across = box
    if min(across) >= reach or max(across) <= -reach:
        return math.inf
    middle = sum(along) / len(along)
    return min(s if abs(d) < reach else middle for s, d in zip(along, across, strict=True))


def _near(scene: Scene, way: Sequence[Pose]) -> list[int]:
    """Return which vehicles on the ego's level may reach into the way ahead, and perhaps a few more.

    From a place to which a box keeps some metres, the way takes as many to come up to it: so far it need not be looked
    at. The box is first taken for its circle, then kept from the straight line that goes on from the place.
    """
    ego, others = scene.ego, scene.others
    room = ego.width / 2 + SIDE_ROOM + SPACING
    columns = (others.x, others.y, others.z, others.heading, others.length, others.width)
    near = []
    for i, (x, y, z, heading, length, width) in enumerate(zip(*(column.tolist() for column in columns), strict=True)):
        circle = math.hypot(length, width) / 2 + room
        here, end = 0, len(way) if abs(z - ego.z) < SAME_LEVEL else 0
        while here < end:
            place = way[here]
            off = math.hypot(x - place.x, y - place.y) - circle
            if off < 0.0:
                off = _beside_line(place, x, y, heading, length, width) - room
                if off < 0.0:
                    near.append(i)
                    break
            here += 1 + int(off / SPACING)
    return near


def _beside_line(line: Pose, x: float, y: float, heading: float, length: float, width: float) -> float:
    """Return how far a box keeps from a straight line [m], negative where it reaches over it."""
    turn = heading - line.heading
    across = abs((y - line.y) * math.cos(line.heading) - (x - line.x) * math.sin(line.heading))
    return across - (length * abs(math.sin(turn)) + width * abs(math.cos(turn))) / 2


def _rims(others: Vehicles, which: list[int]) -> tuple[FloatArray, FloatArray]:
    """Return x and y (K, 8) of points on the rims of K boxes."""
    heading = others.heading[which, None]
    lengthways = others.length[which, None] * LENGTHWAYS
    sideways = others.width[which, None] * SIDEWAYS
    cos, sin = np.cos(heading), np.sin(heading)
    x = others.x[which, None] + lengthways * cos - sideways * sin
    return x, others.y[which, None] + lengthways * sin + sideways * cos


def _beside(
    route: Route, first: int, last: int, x: FloatArray, y: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return how far along (N, K) and left (N, K) of a part of the route points (N, K) are [m].

    The third array (N,) is the route's heading beside each row's first point [rad].
    """
    nearest = _squared_distance(x, y, route.x[first:last], route.y[first:last]).argmin(axis=-1)
    at = first + nearest
    dx, dy, angle = x - route.x[at], y - route.y[at], route.headings[at]
    cos, sin = np.cos(angle), np.sin(angle)
    return nearest * SPACING + dx * cos + dy * sin, dy * cos - dx * sin, angle[:, 0]


def _squared_distance(x: FloatArray, y: FloatArray, way_x: FloatArray, way_y: FloatArray) -> FloatArray:
    """Return the squared distance of each point (...) from each point of a way (P,), as (..., P) [m^2]."""
    dx, dy = np.subtract.outer(x, way_x), np.subtract.outer(y, way_y)
    dx *= dx
    dy *= dy
    dx += dy
    return dx
