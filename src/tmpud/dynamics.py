"""The ego as a kinematic bicycle within its own limits."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tmpud.errors import InvalidStateError
from tmpud.geometry import Pose, wrap_angle
from tmpud.scene import Control, VehicleState


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleLimits:
    """Size and limits of the ego; what it may use to drive, not the estimator's Delta and Theta."""

    length: float = 4.7  # [m]
    width: float = 1.9  # [m]
    wheelbase: float = 2.8  # [m] the axles lie half of it before and behind the centre
    max_speed: float = 20.0 / 3.6  # [m/s]
    max_steering: float = 0.6  # [rad]
    max_acceleration: float = 3.0  # [m/s^2]
    max_braking: float = 8.0  # [m/s^2]
    max_lateral_acceleration: float = 3.0  # [m/s^2]


EGO = VehicleLimits()


def clamp(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def within_limits(control: Control, limits: VehicleLimits = EGO) -> bool:
    """Whether a command is finite and one the vehicle can carry out."""
    return (
        math.isfinite(control.acceleration)
        and math.isfinite(control.steering)
        and -limits.max_braking - 1e-9 <= control.acceleration <= limits.max_acceleration + 1e-9
        and abs(control.steering) <= limits.max_steering + 1e-9
    )


def step(state: VehicleState, control: Control, dt: float, limits: VehicleLimits = EGO) -> VehicleState:
    """Return the state after ``dt`` seconds of one command: kinematic bicycle, turning about the rear axle.

    The pose is the centre of the box, half a wheelbase ahead of the rear axle.
    Raises InvalidStateError for a command or a state that is not finite or beyond the limits.
    """
    if not within_limits(control, limits):
        raise InvalidStateError(f"command {control} is not within the vehicle's limits")
    if not all(map(math.isfinite, (*state.pose, state.speed))):
        raise InvalidStateError(f"the ego's state is not finite: {state.pose}, {state.speed} m/s")
    half = limits.wheelbase / 2
    speed = max(state.speed + control.acceleration * dt, 0.0)
    mean_speed = (state.speed + speed) / 2
    heading = state.pose.heading
    yaw_rate = mean_speed * math.tan(control.steering) / limits.wheelbase
    turned = heading + yaw_rate * dt
    rear_x, rear_y = state.pose.x - half * math.cos(heading), state.pose.y - half * math.sin(heading)
    mid = heading + yaw_rate * dt / 2
    chord = mean_speed * dt * (math.sin(yaw_rate * dt / 2) / (yaw_rate * dt / 2) if abs(yaw_rate * dt) > 1e-9 else 1.0)
    pose = Pose(
        rear_x + chord * math.cos(mid) + half * math.cos(turned),
        rear_y + chord * math.sin(mid) + half * math.sin(turned),
        wrap_angle(turned),
    )
    if not all(map(math.isfinite, (*pose, speed))):
        raise InvalidStateError(f"the ego's state is not finite: {pose}, {speed} m/s")
    acceleration = (speed - state.speed) / dt
    # Not by replace(), which takes three times as long
    return VehicleState(state.id, pose, state.lane, state.z, speed, yaw_rate, acceleration, state.length, state.width)
