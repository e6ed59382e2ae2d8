"""Algorithm 1, lines 3 to 6, one vehicle and one instant after the other, as it reads on paper (steering, no gate)."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from tmpud.dynamics import EGO
from tmpud.presets import Preset
from tmpud.scene import Vehicles
from tmpud.trajectory import Trajectory

TOUCHING = 1e-6  # [m]


class Line(NamedTuple):
    """The safe controls of one instant: ``by_acceleration * a + by_turning * tan(theta) <= limit``."""

    limit: float
    by_acceleration: float
    by_turning: float


def shares(ego: Trajectory, others: Vehicles, preset: Preset, share: Callable[[Line, Preset], float]) -> list[float]:
    """Return o_i(t), vehicle by vehicle."""
    return [share(line, preset) for line in lines(ego, others, preset)]


def lines(ego: Trajectory, others: Vehicles, preset: Preset) -> Iterator[Line]:
    vehicles = zip(
        *(getattr(others, name).tolist() for name in ("x", "y", "heading", "speed", "yaw_rate")), strict=True
    )
    instants = list(zip(ego.times.tolist(), ego.poses.tolist(), ego.speeds.tolist(), strict=True))
    for vehicle in vehicles:
        for time, pose, speed in instants:
            yield _line(pose, speed, _predicted(vehicle, time), vehicle[3:], preset)


def _predicted(vehicle: tuple[float, ...], time: float) -> tuple[float, float, float]:
    """Return where a vehicle that keeps speed and yaw rate is."""
    x, y, heading, speed, yaw_rate = vehicle
    turn = yaw_rate * time
    chord = speed * time * (math.sin(turn / 2) / (turn / 2) if abs(turn) > 1e-9 else 1.0)
    return x + chord * math.cos(heading + turn / 2), y + chord * math.sin(heading + turn / 2), heading + turn


def _line(ego: list[float], speed: float, other: tuple[float, ...], motion: tuple[float, ...], preset: Preset) -> Line:
    """Return phi' <= -eta as a condition on the control (see ``tmpud.safety.control_set``)."""
    (cos, sin), (cos_i, sin_i) = ((math.cos(angle), math.sin(angle)) for angle in (ego[2], other[2]))
    speed_i, yaw_rate_i = motion
    dx, dy = ego[0] - other[0], ego[1] - other[1]
    vx, vy = speed * cos - speed_i * cos_i, speed * sin - speed_i * sin_i
    d = math.hypot(dx, dy)
    if d < TOUCHING:
        return Line(-math.inf, 0.0, 0.0)
    closing = (dx * vx + dy * vy) / d
    turning_i = (dy * cos_i - dx * sin_i) * speed_i * yaw_rate_i
    drift = -2 * d * closing - preset.closing_weight * (vx * vx + vy * vy - turning_i - closing**2) / d
    by_yaw_rate = -preset.closing_weight * speed * (dy * cos - dx * sin) / d
    by_acceleration = -preset.closing_weight * (dx * cos + dy * sin) / d
    return Line(-preset.margin - drift, by_acceleration, by_yaw_rate * speed / EGO.wheelbase)


def sampled(rng: random.Random) -> Callable[[Line, Preset], float]:
    """Return the share among random controls, one by one."""

    def share(line: Line, preset: Preset) -> float:
        (low_a, high_a), (low, high) = preset.acceleration, preset.turning_range
        inside = 0
        for _ in range(preset.samples):
            acceleration, theta = rng.uniform(low_a, high_a), rng.uniform(low, high)
            inside += line.by_acceleration * acceleration + line.by_turning * math.tan(theta) <= line.limit
        return inside / preset.samples

    return share


def sampled_in_rows(rng: Any) -> Callable[[Line, Preset], float]:
    """Return the share among random controls, all of one vehicle and instant in a numpy array."""
    import numpy as np

    def share(line: Line, preset: Preset) -> float:
        acceleration = rng.uniform(*preset.acceleration, preset.samples)
        theta = rng.uniform(*preset.turning_range, preset.samples)
        return float(np.mean(line.by_acceleration * acceleration + line.by_turning * np.tan(theta) <= line.limit))

    return share


def exact(line: Line, preset: Preset) -> float:
    """Return the share in closed form (see ``tmpud.safety.share``)."""
    (low_a, high_a), (low, high) = preset.acceleration, preset.turning_range
    slack = line.limit - min(line.by_acceleration * low_a, line.by_acceleration * high_a)
    span, slope = abs(line.by_acceleration) * (high_a - low_a), abs(line.by_turning)
    if line.by_turning < 0:
        low, high = -high, -low

    def turn_at(rest: float) -> float:
        turn = math.atan(rest / slope) if slope else math.copysign(math.inf, rest)
        return min(max(turn, low), high)

    full, none = turn_at(slack - span), turn_at(slack)
    partial = slack * (none - full) + slope * (math.log(math.cos(none)) - math.log(math.cos(full))) if span else 0.0
    return (full - low + (partial / span if span else 0.0)) / (high - low)
