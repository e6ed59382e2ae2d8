"""Cost and Safe during a drive: what is known of each transition, and for how long (Alg. 2, lines 1, 2 and 6)."""

from __future__ import annotations

import math
from collections.abc import Callable

from tmpud.presets import Preset
from tmpud.symbols import LazyCost, OptimisticSafe, Transition


class Knowledge:
    """The two functions that the motion level updates and the task planner reads."""

    def __init__(self, path_length: Callable[[Transition], float], preset: Preset) -> None:
        self.cost = LazyCost(path_length)
        self.safe = OptimisticSafe()
        self._path_length = path_length
        self._preset = preset
        self._learnt: dict[Transition, float] = {}  # when, in simulated seconds

    def learn(self, step: Transition, safe: float, length: float, now: float) -> None:
        """Update Safe and Cost of a transition (Alg. 2, line 6); ``length`` is A* from the present pose [m]."""
        self.safe[step] = safe
        self._learnt[step] = now
        if math.isinf(length) or self._preset.cost_update == "current pose":
            self.cost[step] = length
        elif self._preset.cost_update == "floored":
            self.cost[step] = max(length, self._path_length(step))

    def forbid(self, step: Transition, safe: float, now: float) -> None:
        """Take a transition out of the planner's choice."""
        self.learn(step, safe, math.inf, now)

    def forget(self, now: float) -> None:
        """Drop what was learnt longer ago than the preset's expiry."""
        expiry = self._preset.safe_expires
        if expiry is None:
            return
        for step in [step for step, then in self._learnt.items() if now - then > expiry]:
            del self._learnt[step], self.safe[step]
            self.cost.pop(step, None)
