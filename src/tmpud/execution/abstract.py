"""The world of the abstract simulation (Sec. V): how a merge looks and how it ends is drawn from what was learnt.

Estimate and outcome belong together, so they are drawn as a pair. The draw is a hash of trial, transition and visit:
the same for every algorithm, and unchanged until the ego moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from dataclasses import dataclass
from functools import cache
from hashlib import blake2b

import numpy as np

from tmpud.dynamics import EGO
from tmpud.events import Event, Judged
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Outcome
from tmpud.symbols import State, TaskPlan, Transition
from tmpud.trajectory import Trajectory

MERGE, COLLIDE, STOP = "merge", "collide", "stop"  # the outcomes of a merge
TIME_LIMIT = 1800.0  # [s] simulated, as in the full simulation


@dataclass(frozen=True, slots=True)
class JointSample:
    """Learning runs of one road condition: Safe before the merge, and how the merge ended; both (n,)."""

    safe: tuple[float, ...]
    outcome: tuple[str, ...]

    def __post_init__(self) -> None:
        if not self.safe or len(self.safe) != len(self.outcome):
            raise ValueError(f"{len(self.safe)} values of Safe do not go with {len(self.outcome)} outcomes")

    def draw(self, key: str) -> tuple[float, str]:
        """Return the pair that a key stands for."""
        number = int.from_bytes(blake2b(key.encode(), digest_size=8).digest(), "big") % len(self.safe)
        return self.safe[number], self.outcome[number]


class AbstractWorld:
    """Roads without vehicles: merges end as drawn, anything else is safe, and every action costs its length."""

    def __init__(self, length: Callable[[Transition], float], sample: JointSample, trial: str) -> None:
        """``length`` is A*(x, x') between canonical poses [m]; ``trial`` names the trial in every draw."""
        self.path_length = length
        self._sample, self._trial = sample, trial
        self._visits: dict[State, int] = {}  # how often the ego has left a state
        self._estimated: set[Transition] = set()
        self.distance = 0.0  # [m]
        self.collisions = self.stops = 0

    @property
    def time(self) -> float:
        """Simulated time [s] of a drive at constant speed."""
        return self.distance / EGO.max_speed

    def estimate(self, step: Transition) -> SafetyEstimate:
        """Return the drawn Safe of a merge, 1.0 of anything else."""
        self._estimated.add(step)
        return _estimate(self._draw(step)[0]) if step.action.is_merge else _CERTAIN

    def is_estimated(self, step: Transition) -> bool:
        """Whether this action was estimated since the ego last moved."""
        return step in self._estimated

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:  # noqa: ARG002
        """Drive one action; a merge ends as drawn, and a collision ends the drive."""
        length = self.path_length(step)
        if math.isinf(length):
            return Outcome.INFEASIBLE
        outcome = self._draw(step)[1] if step.action.is_merge else MERGE
        self.distance += length
        self._visits[step.state] = self._visits.get(step.state, 0) + 1
        self._estimated.clear()
        if outcome == COLLIDE:
            self.collisions += 1
            yield Judged(self.time, "collision", None, MERGE, "ego", "drawn")
            return Outcome.COLLIDE
        if outcome == STOP:
            self.stops += 1
            yield Judged(self.time, "forced_stop", None, MERGE, "ego", "drawn")
        return Outcome.TIME_LIMIT if self.time > TIME_LIMIT else Outcome.DONE

    def _draw(self, step: Transition) -> tuple[float, str]:
        (segment, leg), action, _ = step
        return self._sample.draw(f"{self._trial}/{segment}/{leg}/{action}/{self._visits.get(step.state, 0)}")


_HERE = Trajectory(np.zeros(1), np.zeros((1, 3)), np.zeros(1))
_NOBODY = np.ones((0, 1)), np.ones(0)  # o and o* of no vehicle


@cache
def _estimate(safe: float) -> SafetyEstimate:
    return SafetyEstimate(safe, None, safe, (), *_NOBODY, _HERE, _HERE.times)


_CERTAIN = _estimate(1.0)
