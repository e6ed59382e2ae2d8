"""Trajectories in time, and the prediction of surrounding vehicles (Alg. 1, line 3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tmpud.scene import FloatArray, Vehicles

STRAIGHT = 1e-20  # [rad] an angle whose sine is the angle


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Where the ego will be: T instants."""

    times: FloatArray  # (T,) [s], relative to the scene, from 0
    poses: FloatArray  # (T, 3) x, y, heading of the centre of the box
    speeds: FloatArray  # (T,) [m/s]

    @property
    def accelerations(self) -> FloatArray:
        """Change of speed (T,) by finite differences [m/s^2]; 0 for a single instant."""
        return _derivative(self.speeds, self.times)

    @property
    def yaw_rates(self) -> FloatArray:
        """Change of heading (T,) by finite differences, the short way round [rad/s]; 0 for a single instant."""
        return _derivative(np.unwrap(self.poses[:, 2]), self.times)


def predict(others: Vehicles, times: FloatArray) -> FloatArray:
    """Return the poses (N, T, 3) of N vehicles that keep their speed and yaw rate (Alg. 1, line 3)."""
    turn = others.yaw_rate[:, None] * times  # (N, T)
    half = turn / 2
    mid = others.heading[:, None] + half
    half[half == 0] = STRAIGHT
    chord = others.speed[:, None] * times * (np.sin(half) / half)
    poses = np.empty((*turn.shape, 3))
    poses[..., 0] = others.x[:, None] + chord * np.cos(mid)
    poses[..., 1] = others.y[:, None] + chord * np.sin(mid)
    poses[..., 2] = others.heading[:, None] + turn
    return poses


def _derivative(values: FloatArray, times: FloatArray) -> FloatArray:
    return np.asarray(np.gradient(values, times)) if len(times) > 1 else np.zeros_like(values)
