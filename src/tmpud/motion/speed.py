"""The speed planner: how hard to accelerate behind a leader, before a stop line and in a curve."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tmpud.dynamics import clamp
from tmpud.motion.route import SPACING, Route
from tmpud.scene import Scene, VehicleState

ACCELERATION = 2.0  # [m/s^2] comfortable
BRAKING = 2.0  # [m/s^2] comfortable
HEADWAY = 1.0  # [s] behind a leader
STANDING_GAP = 2.0  # [m] between bumpers in a queue
LINE_GAP = 0.8  # [m] before a stop line
LOOK_AHEAD = 50.0  # [m]
SAME_LEVEL = 3.0  # [m]


class Obstacle(NamedTuple):
    """Something ahead on the route that must not be reached."""

    gap: float  # [m] from the ego's front bumper
    speed: float  # [m/s] along the route


def leader(scene: Scene, route: Route, station: float, ego: VehicleState | None = None) -> Obstacle | None:
    """Return the nearest vehicle ahead whose box reaches into the ego's way, within LOOK_AHEAD metres."""
    ego, others = ego or scene.ego, scene.others
    near = np.hypot(others.x - ego.pose.x, others.y - ego.pose.y) < LOOK_AHEAD + ego.length
    others = others.take(near & (np.abs(others.z - ego.z) < SAME_LEVEL))
    if not len(others):
        return None
    first, last = route.index(station), route.index(station + LOOK_AHEAD + ego.length) + 1
    points = route.points[first:last]
    dx = others.x[:, None] - points[:, 0]
    dy = others.y[:, None] - points[:, 1]
    nearest = np.argmin(dx * dx + dy * dy, axis=1)
    rows = np.arange(len(others))
    dx, dy, angle = dx[rows, nearest], dy[rows, nearest], route.headings[first + nearest]
    along = nearest * SPACING + dx * np.cos(angle) + dy * np.sin(angle)
    across = np.abs(dy * np.cos(angle) - dx * np.sin(angle))
    turned = others.heading - angle
    sideways = (others.width * np.abs(np.cos(turned)) + others.length * np.abs(np.sin(turned))) / 2
    lengthways = (others.length * np.abs(np.cos(turned)) + others.width * np.abs(np.sin(turned))) / 2
    start = station - first * SPACING
    in_way = (across < sideways + ego.width / 2 + 0.2) & (along > start)
    if not in_way.any():
        return None
    gaps = np.where(in_way, along - lengthways - start - ego.length / 2, math.inf)
    i = int(np.argmin(gaps))
    return Obstacle(float(gaps[i]), max(float(others.speed[i] * np.cos(turned[i])), 0.0))


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


def _spacing(route: Route) -> float:
    return route.length / (len(route.points) - 1)
