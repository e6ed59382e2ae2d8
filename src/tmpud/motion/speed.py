"""The speed planner: how hard to accelerate behind a leader, before a stop line and in a curve."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.dynamics import clamp
from tmpud.motion.route import SPACING, Route
from tmpud.scene import FloatArray, Scene, Vehicles

ACCELERATION = 2.0  # [m/s^2] comfortable
BRAKING = 2.0  # [m/s^2] comfortable
HEADWAY = 1.0  # [s] behind a leader
STANDING_GAP = 2.0  # [m] between bumpers in a queue
LINE_GAP = 0.8  # [m] before a stop line
LOOK_AHEAD = 50.0  # [m]
SAME_LEVEL = 3.0  # [m]
SIDE_ROOM = 0.25  # [m] kept free beside the ego
LENGTHWAYS = np.array([1, 1, 1, 0, 0, -1, -1, -1]) / 2  # eight points on a box's rim, as shares of its length ...
SIDEWAYS = np.array([1, 0, -1, 1, -1, 1, 0, -1]) / 2  # ... and of its width
COARSE = 4  # points of the route from one to the next where a first look is taken at who is near it


class Obstacle(NamedTuple):
    """Something ahead on the route that must not be reached."""

    gap: float  # [m] from the ego's front bumper
    speed: float  # [m/s] along the route


def leader(scene: Scene, route: Route, station: float) -> Obstacle | None:
    """Return the nearest vehicle ahead whose box reaches into the ego's way, within LOOK_AHEAD metres."""
    ego, others = scene.ego, scene.others
    first, last = route.index(station), route.index(station + LOOK_AHEAD + ego.length) + 1
    near = _near(scene, route.x[first:last:COARSE], route.y[first:last:COARSE])
    if not near.size:
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


def _near(scene: Scene, x: FloatArray, y: FloatArray) -> NDArray[np.intp]:
    """Return which vehicles on the ego's level have a circle that comes near the way ahead (P,), and a few more."""
    ego, others = scene.ego, scene.others
    reach = (np.hypot(others.length, others.width) + ego.width) / 2 + SIDE_ROOM + COARSE * SPACING
    near: NDArray[np.bool_] = np.minimum.reduce(_squared_distance(others.x, others.y, x, y), axis=-1) < reach * reach
    near &= np.abs(others.z - ego.z) < SAME_LEVEL
    return near.nonzero()[0]


def _rims(others: Vehicles, which: NDArray[np.intp]) -> tuple[FloatArray, FloatArray]:
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


def acceleration(route: Route, station: float, speed: float, obstacles: list[Obstacle], stop: float | None) -> float:
    """Return the acceleration to ask for [m/s^2].

    ``stop`` is how far the front bumper is from a line it must not cross [m], None where the way is free. Leaders are
    followed by the intelligent driver model (Treiber et al. 2000).
    """
    ahead = min(float(route.speed_limit[route.index(station)]), float(route.speed_limit[route.index(station + 1.5)]))
    wish = clamp((ahead - speed) / 0.5, -4.0, ACCELERATION)
    for obstacle in obstacles:
        wish = min(wish, follow(speed, ahead, obstacle, STANDING_GAP))
    if stop is not None:
        wish = min(wish, follow(speed, ahead, Obstacle(stop, 0.0), LINE_GAP))
    return wish


def follow(speed: float, wished: float, obstacle: Obstacle, standing_gap: float) -> float:
    """Return the intelligent driver model's acceleration [m/s^2] behind one obstacle."""
    closing = speed * (speed - obstacle.speed) / (2 * math.sqrt(ACCELERATION * BRAKING))
    desired = standing_gap + max(speed * HEADWAY + closing, 0.0)
    free = 1 - (speed / max(wished, 0.1)) ** 4
    return ACCELERATION * (free - (desired / max(obstacle.gap, 0.1)) ** 2)
