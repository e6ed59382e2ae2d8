"""Trajectories in time, and the prediction of surrounding vehicles (Alg. 1, line 3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tmpud.scene import ComplexArray, FloatArray, Vehicles

STRAIGHT = 1e-20  # [rad/s] below it a vehicle drives straight on; keeps 0 / 0 away


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Where the ego will be: T instants."""

    times: FloatArray  # (T,) [s], relative to the scene, from 0
    poses: FloatArray  # (T, 3) x, y, heading of the centre of the box
    speeds: FloatArray  # (T,) [m/s]

    @property
    def places(self) -> ComplexArray:
        """The centres x + iy (T,) [m]."""
        return points(self.poses[:, 0], self.poses[:, 1])

    @property
    def accelerations(self) -> FloatArray:
        """Change of speed (T,) by finite differences [m/s^2]; 0 for a single instant."""
        return _derivative(self.speeds, self.times)

    @property
    def yaw_rates(self) -> FloatArray:
        """Change of heading (T,) by finite differences, the short way round [rad/s]; 0 for a single instant."""
        return _derivative(np.unwrap(self.poses[:, 2]), self.times)


class Prediction(NamedTuple):
    """Where N vehicles will be at T instants, and how fast they will go which way."""

    places: ComplexArray  # (N, T) centres of their boxes, x + iy [m]
    velocities: ComplexArray  # (N, T) [m/s]


def predict(others: Vehicles, times: FloatArray) -> Prediction:
    """Return where N vehicles are at times (T,) [s] if they keep their speed v and yaw rate w (Alg. 1, line 3).

    A velocity V = v e^(i heading) becomes V e^(iwt), and a place moves by its integral, V (e^(iwt) - 1) / (iw).
    """
    yaw_rate = others.yaw_rate.copy()
    yaw_rate[np.abs(yaw_rate) < STRAIGHT] = STRAIGHT
    velocity = others.speed * direction(others.heading)
    tangent = np.tan((yaw_rate / 2)[:, None] * times)  # (N, T) of wt / 2; quicker than a sine and a cosine
    sine = tangent / (1 + tangent * tangent)  # half of that of wt
    arc = points(sine, tangent * sine)  # (e^(iwt) - 1) / 2i
    moved = (2 * velocity / yaw_rate)[:, None] * arc
    return Prediction(points(others.x, others.y)[:, None] + moved, velocity[:, None] * (1 + 2j * arc))


def points(x: FloatArray, y: FloatArray) -> ComplexArray:
    """Return x + iy, in an array of their shape."""
    both = np.empty(x.shape, np.complex128)
    both.real, both.imag = x, y
    return both


def direction(heading: FloatArray) -> ComplexArray:
    """Return the unit vectors of that heading [rad], in an array of its shape."""
    return points(np.cos(heading), np.sin(heading))


def _derivative(values: FloatArray, times: FloatArray) -> FloatArray:
    return np.asarray(np.gradient(values, times)) if len(times) > 1 else np.zeros_like(values)
