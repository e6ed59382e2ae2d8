"""The independent brake: it checks commands, never traffic, so that it cannot rescue a bad decision."""

from __future__ import annotations

from dataclasses import dataclass

from tmpud.dynamics import EGO, VehicleLimits, within_limits
from tmpud.scene import Control


@dataclass(slots=True)
class Guard:
    """Lets through commands that the vehicle can carry out; for any other, or for none, it brakes for good."""

    limits: VehicleLimits = EGO
    refused: str | None = None  # the first command that was refused

    def check(self, command: Control | None) -> Control:
        """Return the command itself; after the first one that is refused, full braking with the wheels straight."""
        if self.refused is None:
            if command is not None and within_limits(command, self.limits):
                return command
            self.refused = "no command" if command is None else f"{command} is not within the vehicle's limits"
        return Control(-self.limits.max_braking, 0.0)
