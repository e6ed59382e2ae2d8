"""The tracking controller (Sec. IV-C): PID on the lateral and on the longitudinal error, with anti-windup."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from tmpud.dynamics import EGO, VehicleLimits, clamp
from tmpud.geometry import wrap_angle
from tmpud.motion.route import Route
from tmpud.scene import Control, VehicleState


@dataclass(slots=True)
class PID:
    """A PID controller whose integral stops while the output is saturated."""

    proportional: float
    integral: float
    derivative: float
    limit: float  # of the output, either way
    _sum: float = field(default=0.0, init=False)
    _last: float | None = field(default=None, init=False)

    def __call__(self, error: float, dt: float) -> float:
        slope = 0.0 if self._last is None else (error - self._last) / dt
        self._last = error
        total = self._sum + error * dt
        output = self.proportional * error + self.integral * total + self.derivative * slope
        if abs(output) < self.limit:
            self._sum = total
        return clamp(output, -self.limit, self.limit)


class Tracker:
    """Follows one route: steering from curvature ahead plus PID, acceleration from a wish plus PID."""

    def __init__(self, route: Route, limits: VehicleLimits = EGO) -> None:
        self.route = route
        self._limits = limits
        self._lateral = PID(0.12, 0.02, 0.05, 0.4)
        self._longitudinal = PID(1.5, 0.1, 0.0, 2.0)
        self._reference: float | None = None  # [m/s] the speed the car should have by now

    def control(self, ego: VehicleState, station: float, offset: float, wish: float, dt: float) -> Control:
        """Return the command for one step.

        ``offset`` is how far the ego is left of the route at ``station`` [m]; ``wish`` is the acceleration that the
        speed planner asks for [m/s^2].
        """
        return Control(self._accelerate(ego, wish, dt), self._steer(ego, station, offset, dt))

    def _steer(self, ego: VehicleState, station: float, offset: float, dt: float) -> float:
        here = self.route.index(station)
        forward = math.atan(self._limits.wheelbase * float(self.route.curvature[here]))
        slip = math.atan(math.tan(forward) / 2)  # the box's centre moves at this angle to its heading
        heading_error = wrap_angle(float(self.route.headings[here]) - slip - ego.pose.heading)
        steering = forward + 0.8 * heading_error + self._lateral(-offset, dt)
        return clamp(steering, -self._limits.max_steering, self._limits.max_steering)

    def _accelerate(self, ego: VehicleState, wish: float, dt: float) -> float:
        if self._reference is None or abs(self._reference - ego.speed) > 1.0:
            self._reference = ego.speed
        correction = self._longitudinal(self._reference - ego.speed, dt)
        command = clamp(wish + correction, -self._limits.max_braking, self._limits.max_acceleration)
        self._reference = max(self._reference + clamp(wish, -8.0, 3.0) * dt, 0.0)
        return command
