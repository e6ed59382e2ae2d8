"""Follows a run's events and explains each change of plan where it happens."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from tmpud.events import Estimated, Event, Executed, Planned, Refused
from tmpud.presets import Preset
from tmpud.symbols import TaskPlan
from tmpud.viewer.memory import Memory
from tmpud.viewer.reasons import Change, Situation, explain


def changes(events: Iterable[Event], preset: Preset, street_of: Callable[[str], str] = str) -> Iterator[Change]:
    """Yield an explanation of every plan but the first one; ``street_of`` says what a lane's road is called."""
    watch = _Watch(preset, street_of)
    for event in events:
        match event:
            case Planned():
                yield from watch.planned(event)
            case Estimated():
                watch.estimated(event)
            case Refused():
                watch.refused = event
            case Executed(outcome="done"):
                watch.executed()


class _Watch:
    """The plan that is being driven, and what was learnt of its next action."""

    def __init__(self, preset: Preset, street_of: Callable[[str], str]) -> None:
        self._memory, self._street_of = Memory(preset), street_of
        self._plan: Planned | None = None
        self._number = -1
        self._driven = 0  # actions of the plan
        self._estimate: Estimated | None = None
        self._old_safe = 1.0
        self.refused: Refused | None = None

    def planned(self, event: Planned) -> Iterator[Change]:
        self._number += 1
        self._memory.note_plans(event)
        if self._plan is not None:
            yield explain(self._situation(event, self._plan))
        self._plan, self._driven, self._estimate, self.refused = event, 0, None, None

    def estimated(self, event: Estimated) -> None:
        self._old_safe = self._memory.safe(event.step, event.time)
        self._memory.note_estimate(event)
        self._estimate = event

    def executed(self) -> None:
        self._driven += 1
        self._estimate = None

    def _situation(self, new: Planned, old: Planned) -> Situation:
        done, rest = old.plan[: self._driven], old.plan[self._driven :]
        estimate = self._estimate if rest and self._estimate and self._estimate.step == rest[0] else None
        listed: tuple[TaskPlan, ...] = tuple(plan for plan, _, _ in old.alternatives)
        road = self._street_of(self.refused.step.state.segment.rpartition("/")[0]) if self.refused else ""
        known = (estimate, self.refused, self._memory, self._old_safe)
        return Situation(self._number, new, done, rest, road, listed, *known)
