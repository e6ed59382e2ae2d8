"""The safe control set U_i^S of Algorithm 1, line 5, after the safe-set algorithm of Liu and Tomizuka (2016).

Between the ego E and vehicle i, with dp = p_E - p_i, dv = v_E - v_i, d = |dp| and d' = dp.dv / d::

    phi  = D^2 - d^2 - alpha d'
    phi' = -2 d d' - alpha d''      d'' = (|dv|^2 - d'^2 + dp.(a_E - a_i)) / d
    U_i^S = {u : phi' <= -eta} where phi >= 0, else all of Delta x Theta

The ego accelerates by a_E = a e + v w n (e ahead, n to its left, yaw rate w), the vehicle by a_i = v_i w_i n_i,
so phi' is affine in a and w, and U_i^S is Delta x Theta cut by a line. |dv|^2 - d'^2 is (dv x dp)^2 / d^2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.presets import Preset
from tmpud.scene import ComplexArray, FloatArray, Vehicles
from tmpud.trajectory import Prediction, Trajectory, direction

TOUCHING = 1e-6  # [m] centres closer than this have no direction between them: no control is safe


class SafetyIndex(NamedTuple):
    """phi, and phi' as an affine function of the ego's control; each field of shape (N, T)."""

    phi: FloatArray  # [m^2]; D^2 where d < TOUCHING
    drift: FloatArray  # [m^2/s] phi' of an ego that neither accelerates nor turns; inf where d < TOUCHING
    by_acceleration: FloatArray  # [m^2/s per m/s^2] c_a
    by_yaw_rate: FloatArray  # [m^2/s per rad/s] c_w

    def rate(self, acceleration: FloatArray, yaw_rate: FloatArray) -> FloatArray:
        """Return phi' (N, T) under the controls of T instants."""
        return self.drift + self.by_acceleration * acceleration + self.by_yaw_rate * yaw_rate


class HalfPlane(NamedTuple):
    """The controls with ``by_acceleration * a + by_turning * x <= limit``, in arrays of one shape.

    x is the yaw rate, or the tangent of the steering angle.
    """

    limit: FloatArray
    by_acceleration: FloatArray
    by_turning: FloatArray

    def at(self, where: NDArray[np.bool_]) -> HalfPlane:
        """Return the half-planes at which ``where`` is true, in one row."""
        return HalfPlane(*(values[where] for values in self))


class Controls(NamedTuple):
    """The rectangle Delta x Theta; neither range may be reversed, and Theta must not be a single value."""

    acceleration: tuple[float, float]  # Delta [m/s^2]
    turning: tuple[float, float]  # Theta [rad] or [rad/s]
    steering: bool  # whether Theta holds steering angles, else yaw rates

    @property
    def effects(self) -> tuple[float, float]:
        """The ends of Theta as HalfPlane's x."""
        low, high = self.turning
        return (math.tan(low), math.tan(high)) if self.steering else (low, high)


class SafeSets(NamedTuple):
    """U_i^S of N vehicles at T instants: all of Delta x Theta, or where ``cut`` a half-plane of it."""

    cut: NDArray[np.bool_]  # (N, T)
    plane: HalfPlane  # of the K cut ones, row by row
    controls: Controls  # Delta x Theta


def safety_index(ego: Trajectory, others: Vehicles, predicted: Prediction, preset: Preset) -> SafetyIndex:
    """Return the index (N, T) of every predicted vehicle at every instant of the ego's trajectory."""
    dp = ego.places - predicted.places
    distance = np.abs(dp)
    d = np.maximum(distance, TOUCHING)
    pushing = _inner(direction(ego.poses[:, 2]), dp)  # dp.e and dp.n
    own, theirs = ego.speeds * pushing, _inner(predicted.velocities, dp)  # the same with v_E e, and with v_i
    moving = own - theirs  # dp.dv = d d', and dv x dp
    d_dot, swing, weight = moving.real / d, moving.imag / d, -preset.closing_weight / d
    turning_i = theirs.imag * others.yaw_rate[:, None]  # dp.a_i
    drifting = swing * swing - turning_i  # d d'' of an ego that neither accelerates nor turns
    index = SafetyIndex(
        phi=preset.safety_distance**2 - d * d - preset.closing_weight * d_dot,
        drift=weight * drifting - 2 * moving.real,
        by_acceleration=weight * pushing.real,
        by_yaw_rate=weight * own.imag,
    )
    touching = distance < TOUCHING
    index.phi[touching], index.drift[touching] = preset.safety_distance**2, np.inf
    return index


def in_use(index: SafetyIndex, ego: Trajectory, preset: Preset) -> NDArray[np.bool_]:
    """Return where (N, T) the gate is open, so that U_i^S is the half-plane and not all of Delta x Theta.

    The gate looks at phi and at phi' under the control that the planned trajectory itself applies.
    """
    near = index.phi > preset.gate if preset.strict_gate else index.phi >= preset.gate
    if preset.gate_rate == -np.inf:
        return near
    return near & (index.rate(ego.accelerations, ego.yaw_rates) > preset.gate_rate)


def half_plane(index: SafetyIndex, ego: Trajectory, preset: Preset, wheelbase: float) -> HalfPlane:
    """Return phi' <= -eta as a condition on the preset's controls; w = v tan(theta) / L where they steer."""
    per_turning = ego.speeds / wheelbase if preset.turning == "steering" else 1.0
    return HalfPlane(-preset.margin - index.drift, index.by_acceleration, index.by_yaw_rate * per_turning)


def controls(preset: Preset) -> Controls:
    """Return the preset's Delta x Theta."""
    return Controls(preset.acceleration, preset.turning_range, preset.turning == "steering")


def _inner(a: ComplexArray, b: ComplexArray) -> ComplexArray:
    """Return a.b, and as its imaginary part how far b leads to the left of a, times the length of a."""
    return np.conj(a) * b
