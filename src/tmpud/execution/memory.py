"""Drives that are known already: the same actions in the same town end the same way, and need no second simulation.

Algorithms that decide alike drive alike. What came of each action is noted under all the actions before it, by whoever
drives them first; another algorithm takes it from there, makes up its own mind about every next action, and is as well
informed as if it had driven itself: the scene is the same, and so is what it remembers of the lights.
"""

from __future__ import annotations

from collections.abc import Generator, Hashable
from typing import Any, NamedTuple

from tmpud.events import Event
from tmpud.execution.worlds import SimulatedWorld
from tmpud.motion.signals import Switched
from tmpud.scene import Outcome, Scene
from tmpud.symbols import TaskPlan, Transition

History = tuple[Hashable, ...]  # where the drive began, then each action with the plan for what follows


class Moment(NamedTuple):
    """What came of an action, and all that can be seen when it has ended."""

    events: tuple[Event, ...]
    outcome: Outcome
    scene: Scene
    lights: Switched
    distance: float  # [m] since the drive began
    metrics: dict[str, float]
    refused: str | None


Memory = dict[History, Moment]


class UnknownError(Exception):
    """Nobody has driven so."""


class _Remembering(SimulatedWorld):
    _history: History

    def __init__(self, memory: Memory, *parts: Any, **options: Any) -> None:
        """``parts`` and ``options`` are those of the simulated world."""
        super().__init__(*parts, **options)
        self._memory = memory


class RecordedWorld(_Remembering):
    """A simulated world that notes what comes of each action."""

    def enter(self, lane: str, station: float) -> None:
        super().enter(lane, station)
        self._history = ((lane, station),)
        self._note((), Outcome.DONE)

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:
        events: list[Event] = []
        drive = super().execute(step, upcoming)
        while True:
            try:
                events.append(next(drive))
            except StopIteration as end:
                self._history += ((step, upcoming),)
                self._note(tuple(events), end.value)
                return Outcome(end.value)
            yield events[-1]

    def _note(self, events: tuple[Event, ...], outcome: Outcome) -> None:
        self._memory[self._history] = Moment(
            events, outcome, self.scene, self._motion.lights, self.distance, dict(self.metrics), self.refused
        )


class RecalledWorld(_Remembering):
    """A world in which only what is known can be driven, and the simulator is never asked; else UnknownError."""

    def enter(self, lane: str, station: float) -> None:
        self._history = ((lane, station),)
        self._recall()
        self.began = self.scene.time

    def leave(self) -> None:
        """Leave the simulator as it is, for whoever drives after all."""

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:
        self._history += ((step, upcoming),)
        before = self.time
        self._recall()
        if self.time > before:
            self._estimates.clear()
        yield from self._moment.events
        return self._moment.outcome

    @property
    def metrics(self) -> dict[str, float]:
        return self._moment.metrics

    @property
    def refused(self) -> str | None:
        return self._moment.refused

    def _recall(self) -> None:
        if self._history not in self._memory:
            raise UnknownError
        self._moment = moment = self._memory[self._history]
        self.scene, self.distance, self._motion.lights = moment.scene, moment.distance, moment.lights
