"""What a run knew at each moment, taken from its events: Safe of each action, and what a plan costs with it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from tmpud.events import Estimated, Planned
from tmpud.presets import Preset
from tmpud.symbols import TaskPlan, Transition
from tmpud.task.utility import penalty, turn_cost


def preset_of(settings: Mapping[str, Any]) -> Preset:
    """Return the preset that a header tells field by field; KeyError where one is missing."""
    return Preset(**{field.name: _value(settings[field.name]) for field in fields(Preset)})


class Memory:
    """Costs and estimates up to a moment."""

    def __init__(self, preset: Preset) -> None:
        self.preset = preset
        self._safe: dict[Transition, tuple[float, float]] = {}  # Safe, and when it was learnt [s]
        self._cost: dict[Transition, float] = {}  # [m]
        self._lengths: dict[TaskPlan, float] = {}  # [m] of the plans that were listed

    def note_plans(self, event: Planned) -> None:
        """Take in what the transitions of a plan, and the plans beside it, cost."""
        self._cost.update(zip(event.plan, map(float, event.cost), strict=True))
        self._lengths.update((plan, float(cost)) for plan, cost, _ in event.alternatives)

    def note_estimate(self, event: Estimated) -> None:
        self._safe[event.step] = event.safe, event.time

    def safe(self, step: Transition, now: float) -> float:
        """Return what Safe was taken to be: 1 where it was not estimated, or too long ago."""
        value, then = self._safe.get(step, (1.0, now))
        expiry = self.preset.safe_expires
        return 1.0 if expiry is not None and now - then > expiry else value

    def penalty(self, plan: Iterable[Transition], now: float) -> float:
        """Return the safety term of a plan at a moment [m]."""
        return math.fsum(penalty(self.safe(step, now), self.preset) for step in plan)

    def turns(self, plan: Iterable[Transition]) -> float:
        """Return what is added for a plan's turns [m]."""
        return math.fsum(turn_cost(step.action, self.preset) for step in plan)

    def length(self, plan: TaskPlan, done: TaskPlan = ()) -> float | None:
        """Return a plan's Cost [m], None where it is not known; the plan may be one that began with ``done``."""
        steps = [self._cost.get(step) for step in plan]
        if None not in steps:
            return math.fsum(step for step in steps if step is not None)
        before = [self._cost.get(step) for step in done]
        if None in before or done + plan not in self._lengths:
            return None
        return self._lengths[done + plan] - math.fsum(step for step in before if step is not None)

    def least_safe(self, most: float) -> float | None:
        """Return the least Safe whose penalty is at most ``most`` [m]; None where no Safe in [0, 1] is enough."""
        if penalty(1.0, self.preset) > most:
            return None
        if penalty(0.0, self.preset) <= most:
            return 0.0
        full = most + (0.0 if self.preset.constant_term else self.preset.gamma / 2)
        return 1.0 + math.log(self.preset.gamma / full - 1.0)


def _value(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return tuple(map(_value, value))
    return float(value) if value in ("inf", "-inf") else value
