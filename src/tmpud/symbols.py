"""The symbolic side of a drive: actions, states, transitions, plans (Sec. III and IV-C of the paper)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class Action(StrEnum):
    """The five actions of the paper, spelled as there."""

    MERGELEFT = "mergeleft"
    MERGERIGHT = "mergeright"
    FORWARD = "forward"
    TURNLEFT = "turnleft"
    TURNRIGHT = "turnright"

    @property
    def is_merge(self) -> bool:
        return self.startswith("merge")


class State(NamedTuple):
    """The lane segment the ego is on, and how many goals of the request it has reached."""

    segment: str
    leg: int


class Transition(NamedTuple):
    """<s, a, s'>: doing an action in a state leads to the next state."""

    state: State
    action: Action
    next_state: State


TaskPlan = tuple[Transition, ...]  # plan[0], plan[1:] and == are Algorithm 2's own operations
Cost = Mapping[Transition, float]  # [m]; inf: the transition cannot be driven or is forbidden
Safe = Mapping[Transition, float]  # [0, 1]


class LazyCost(dict[Transition, float]):
    """Cost(<s, a, s'>), computed by the motion planner when it is first asked for (Alg. 2, line 1)."""

    def __init__(self, path_length: Callable[[Transition], float]) -> None:
        super().__init__()
        self._path_length = path_length

    def __missing__(self, transition: Transition) -> float:
        self[transition] = cost = self._path_length(transition)
        return cost


class OptimisticSafe(dict[Transition, float]):
    """Safe(<s, a, s'>), 1.0 until estimated (Alg. 2, line 2); ``in`` tells whether it was estimated."""

    def __missing__(self, transition: Transition) -> float:
        return 1.0


@dataclass(frozen=True, slots=True)
class Place:
    """A start or a goal: any of some lane segments, or one position on one lane."""

    name: str  # as the user wrote it
    segments: tuple[str, ...]  # any of them will do; the first one is where a drive starts
    station: float | None = None  # [m] along the lane of the only segment; None: anywhere on it


@dataclass(frozen=True, slots=True)
class ServiceRequest:
    """From a start to one goal or to several in their order."""

    start: Place
    goals: tuple[Place, ...]

    def start_state(self) -> State:
        """Return the state a drive begins in: goals that the start itself reaches are done."""
        return State(self.start.segments[0], self._skip(self.start.segments[0], 0))

    def leg_after(self, segment: str, leg: int) -> int:
        """Return the leg that arriving on a segment in some leg leads to."""
        if leg == len(self.goals) or segment not in self.goals[leg].segments:
            return leg
        return self._skip(segment, leg + 1)

    def _skip(self, segment: str, leg: int) -> int:
        """Return the first leg from ``leg`` on whose goal is not reached just by being on a segment."""
        while leg < len(self.goals) and self.goals[leg].station is None and segment in self.goals[leg].segments:
            leg += 1
        return leg

    def positions(self) -> dict[State, float]:
        """Return the states whose pose the request itself names, with their station on the lane [m]."""
        found = {} if self.start.station is None else {self.start_state(): self.start.station}
        for leg, goal in enumerate(self.goals):
            if goal.station is not None:
                found[State(goal.segments[0], self.leg_after(goal.segments[0], leg))] = goal.station
        return found
