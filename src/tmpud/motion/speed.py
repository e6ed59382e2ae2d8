"""The speed planner: how hard to accelerate behind a leader, before a stop line and in a curve."""

from __future__ import annotations

import math

from tmpud.dynamics import clamp
from tmpud.motion.leading import Obstacle
from tmpud.motion.route import Route

ACCELERATION = 2.0  # [m/s^2] comfortable
BRAKING = 2.0  # [m/s^2] comfortable
HEADWAY = 1.0  # [s] behind a leader
STANDING_GAP = 2.0  # [m] between bumpers in a queue
LINE_GAP = 0.8  # [m] before a stop line


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
