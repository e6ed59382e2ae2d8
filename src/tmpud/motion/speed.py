"""The speed planner: how hard to accelerate behind a leader, before a stop line and in a curve."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

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


class Obstacle(NamedTuple):
    """Something ahead on the route that must not be reached."""

    gap: float  # [m] from the ego's front bumper
    speed: float  # [m/s] along the route


def leader(scene: Scene, route: Route, station: float) -> Obstacle | None:
    """Return the nearest vehicle ahead whose box reaches into the ego's way, within LOOK_AHEAD metres."""
    ego = scene.ego
    others = _near(scene)
    if not len(others):
        return None
    first, last = route.index(station), route.index(station + LOOK_AHEAD + ego.length) + 1
    along, across, angle = _beside(route, first, last, _rims(others))
    reach = ego.width / 2 + SIDE_ROOM
    left, right = across.max(axis=1), across.min(axis=1)
    in_way = (right < reach) & (left > -reach) & (along.max(axis=1) > station - first * SPACING)
    if not in_way.any():
        return None
    within = np.where(np.abs(across) < reach, along, along.mean(axis=1, keepdims=True))
    gaps = np.where(in_way, within.min(axis=1) - (station - first * SPACING) - ego.length / 2, math.inf)
    i = int(np.argmin(gaps))
    speed = float(others.speed[i] * np.cos(others.heading[i] - angle[i]))
    return Obstacle(float(gaps[i]), max(speed, 0.0))


def _near(scene: Scene) -> Vehicles:
    """Return the vehicles on the ego's level that are within reach."""
    ego, others = scene.ego, scene.others
    distance = np.hypot(others.x - ego.pose.x, others.y - ego.pose.y)
    return others.take((distance < LOOK_AHEAD + ego.length) & (np.abs(others.z - ego.z) < SAME_LEVEL))


def _rims(others: Vehicles) -> FloatArray:
    """Return points on the rims of N boxes: (N, 8, 2)."""
    lengthways = others.length[:, None] / 2 * np.array([1, 1, 1, 0, 0, -1, -1, -1])
    sideways = others.width[:, None] / 2 * np.array([1, 0, -1, 1, -1, 1, 0, -1])
    cos, sin = np.cos(others.heading)[:, None], np.sin(others.heading)[:, None]
    x = others.x[:, None] + lengthways * cos - sideways * sin
    y = others.y[:, None] + lengthways * sin + sideways * cos
    return np.stack([x, y], axis=-1)


def _beside(route: Route, first: int, last: int, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return how far along (N, K) and left (N, K) of a part of the route points (N, K, 2) are [m].

    The third array (N,) is the route's heading beside each row's first point [rad].
    """
    part = route.points[first:last]
    dx, dy = points[..., None, 0] - part[:, 0], points[..., None, 1] - part[:, 1]
    nearest = np.argmin(dx * dx + dy * dy, axis=-1)[..., None]
    dx, dy = np.take_along_axis(dx, nearest, -1)[..., 0], np.take_along_axis(dy, nearest, -1)[..., 0]
    angle = route.headings[first + nearest[..., 0]]
    along = nearest[..., 0] * SPACING + dx * np.cos(angle) + dy * np.sin(angle)
    return along, dy * np.cos(angle) - dx * np.sin(angle), angle[:, 0]


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
