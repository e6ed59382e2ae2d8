"""From an acceleration to throttle and brake: CARLA's cars have engines and gears, and no pedal for m/s^2."""

from __future__ import annotations

from dataclasses import dataclass, field

from tmpud.dynamics import clamp

FULL_THROTTLE, FULL_BRAKE = 5.0, 9.0  # [m/s^2] about what a pedal gives at town speeds
LAG = 1.0  # [m/s] the speed that was wished is forgotten where the car is further from it
HELD, STANDING = 0.05, 0.2  # [m/s] a car that shall stand is held by its brake once it is so slow


@dataclass(slots=True)
class Pedals:
    """Keeps to the speed that the accelerations asked for lead to: feed-forward, and PI on what is missing."""

    dt: float  # [s]
    proportional: float = 2.0  # [1/s]
    integral: float = 0.5  # [1/s^2]
    _speed: float | None = field(default=None, init=False)  # [m/s] the car should have by now
    _missing: float = field(default=0.0, init=False)  # [m] sum of the speeds missing

    def press(self, acceleration: float, speed: float) -> tuple[float, float]:
        """Return throttle and brake, in [0, 1], for an acceleration [m/s^2] at a speed [m/s]."""
        if self._speed is None or abs(self._speed - speed) > LAG:
            self._speed, self._missing = max(speed, 0.0), 0.0
        missing = self._speed - speed
        self._speed = max(self._speed + acceleration * self.dt, 0.0)
        if self._speed <= HELD and acceleration <= 0.0 and speed < STANDING:
            self._missing = 0.0
            return 0.0, 1.0
        total = self._missing + missing * self.dt
        wish = acceleration + self.proportional * missing + self.integral * total
        share = clamp(wish / (FULL_THROTTLE if wish > 0.0 else FULL_BRAKE), -1.0, 1.0)
        if abs(share) < 1.0:
            self._missing = total
        return max(share, 0.0), max(-share, 0.0)
