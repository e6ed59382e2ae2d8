"""The safe control set U_i^S of Algorithm 1, line 5, after the safe-set algorithm of Liu and Tomizuka (2016).

Between the ego E and vehicle i, with dp = p_E - p_i, dv = v_E - v_i, d = |dp| and d' = dp.dv / d::

    phi  = D^2 - d^2 - alpha d'
    phi' = -2 d d' - alpha d''      d'' = (|dv|^2 + dp.(a_E - a_i) - d'^2) / d
    U_i^S = {u : phi' <= -eta} where phi >= 0, else all of Delta x Theta

The ego accelerates by a_E = a e + v w n (e ahead, n to its left, yaw rate w), the vehicle by a_i = v_i w_i n_i,
so phi' is affine in a and w, and U_i^S is Delta x Theta cut by a line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.presets import Preset
from tmpud.scene import FloatArray, Vehicles
from tmpud.trajectory import Trajectory

TOUCHING = 1e-6  # [m] centres closer than this have no direction between them: no control is safe


@dataclass(frozen=True, slots=True, eq=False)
class SafetyIndex:
    """phi, and phi' as an affine function of the ego's control; each field of shape (N, T)."""

    phi: FloatArray  # [m^2]
    drift: FloatArray  # [m^2/s] phi' of an ego that neither accelerates nor turns; inf where d < TOUCHING
    by_acceleration: FloatArray  # [m^2/s per m/s^2] c_a
    by_yaw_rate: FloatArray  # [m^2/s per rad/s] c_w

    @property
    def defined(self) -> bool:
        """Whether there is no NaN in it, as finite states leave only where they are too large to be squared."""
        return not bool(np.isnan(self.phi + self.drift + self.by_acceleration + self.by_yaw_rate).any())

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


class SafeSets(NamedTuple):
    """U_i^S of N vehicles at T instants: all of Delta x Theta, or where ``cut`` a half-plane of it."""

    cut: NDArray[np.bool_]  # (N, T)
    plane: HalfPlane  # of the K cut ones, row by row
    controls: Controls  # Delta x Theta


def safety_index(ego: Trajectory, others: Vehicles, predicted: FloatArray, preset: Preset) -> SafetyIndex:
    """Return the index of every predicted vehicle (N, T, 3) at every instant of the ego's trajectory."""
    cos, sin = np.cos(ego.poses[:, 2]), np.sin(ego.poses[:, 2])
    cos_i, sin_i = np.cos(predicted[..., 2]), np.sin(predicted[..., 2])
    dx, dy = ego.poses[:, 0] - predicted[..., 0], ego.poses[:, 1] - predicted[..., 1]
    speed_i = others.speed[:, None]
    dvx, dvy = ego.speeds * cos - speed_i * cos_i, ego.speeds * sin - speed_i * sin_i
    turning_i = (dy * cos_i - dx * sin_i) * (others.speed * others.yaw_rate)[:, None]  # dp.a_i
    d_squared, closing = dx * dx + dy * dy, dx * dvx + dy * dvy  # closing: dp.dv = d d'
    touching = d_squared < TOUCHING**2
    d = np.sqrt(d_squared)
    d[touching] = 1.0
    d_dot, weight = closing / d, -preset.closing_weight / d
    # d d'' of an ego that neither accelerates nor turns
    drifting = dvx * dvx + dvy * dvy - turning_i - d_dot * d_dot
    index = SafetyIndex(
        phi=preset.safety_distance**2 - d_squared - preset.closing_weight * d_dot,
        drift=weight * drifting - 2 * closing,
        by_acceleration=weight * (dx * cos + dy * sin),
        by_yaw_rate=weight * (ego.speeds * (dy * cos - dx * sin)),
    )
    index.drift[touching] = np.inf
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
    """Return the preset's Delta x Theta; raises ValueError for ranges without the sense ``Controls`` needs."""
    (low_a, high_a), (low, high) = preset.acceleration, preset.turning_range
    steering = preset.turning == "steering"
    if not low_a <= high_a:
        raise ValueError(f"acceleration {preset.acceleration} must be (low, high)")
    if not low < high or (steering and not max(-low, high) < np.pi / 2):
        raise ValueError(f"turning_range {preset.turning_range} must be (low, high), steering within a right angle")
    return Controls(preset.acceleration, preset.turning_range, steering)
