"""Plans made once: many trials on one mission ask for the same plan again and again."""

from __future__ import annotations

from hashlib import blake2b
from typing import NamedTuple

from tmpud.errors import NoPlanError
from tmpud.symbols import Cost, LazyCost, Safe, ServiceRequest, State, Transition
from tmpud.task.asp_planner import PlanReport
from tmpud.task.search_planner import SearchPlanner

PROVED = 100  # one plan in so many is proved by clingo

Changes = frozenset[tuple[Transition, float]]
Key = tuple[State, Changes, Changes]  # where, and which Cost and Safe are no longer the first ones


class Made(NamedTuple):
    """A plan, or why there is none, and what clingo says of it."""

    plan: PlanReport | str
    agreed: bool | None = None  # whether clingo's is the same one; None: it was not asked


class PlanMemory:
    """A TaskPlanner for one request that remembers its answers and has some of them proved."""

    def __init__(self, planner: SearchPlanner, first: LazyCost) -> None:
        """``first`` gives the first Cost of every transition."""
        self.preset = planner.preset
        self._planner, self._first = planner, first
        self._cost = LazyCost(first.__getitem__)  # one mapping for all trials, so that the kept tree holds
        self._plans: dict[Key, Made] = {}
        self._asked: set[Key] = set()

    def begin(self) -> None:
        """Count from here on; what was remembered before is counted again when it is asked for."""
        self._asked.clear()

    def counts(self) -> tuple[int, int, int]:
        """Return how many different plans were asked for, how many of them clingo proved, and how many it did not."""
        agreed = [self._plans[key].agreed for key in self._asked]
        return len(agreed), len(agreed) - agreed.count(None), agreed.count(False)

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        """Return the best plan; raises NoPlanError where there is none."""
        first = self._first
        costs = frozenset(item for item in cost.items() if item[1] != first[item[0]])
        key = state, costs, frozenset(item for item in safe.items() if item[1] != 1.0)
        self._asked.add(key)
        found = self._plans.get(key)
        if found is None:
            self._plans[key] = found = self._made(key, request, safe)
        if isinstance(found.plan, str):
            raise NoPlanError(found.plan)
        return found.plan

    def alternatives(
        self,
        state: State,  # noqa: ARG002
        request: ServiceRequest,  # noqa: ARG002
        cost: Cost,  # noqa: ARG002
        safe: Safe,  # noqa: ARG002
        count: int,  # noqa: ARG002
    ) -> tuple[PlanReport, ...]:
        """Return nothing: no abstract trial keeps the plans it did not take."""
        return ()

    def _made(self, key: Key, request: ServiceRequest, safe: Safe) -> Made:
        """Return a new plan, or why there is none."""
        state, changes, _ = key
        self._cost.update(changes)
        try:
            found = self._planner.solve(state, request, self._cost, safe)
            if not _drawn(key):
                return Made(found)
            proof = self._planner.prove(state, request, self._cost, safe)
            return Made(found, (proof.plan, proof.total_cm) == (found.plan, found.total_cm))
        except NoPlanError as error:
            return Made(str(error))
        finally:
            self._cost.update({step: self._first[step] for step, _ in changes})


def _drawn(key: Key) -> bool:
    """Whether a plan is among those that are proved; it depends on nothing but the key."""
    state, *changes = key
    text = repr((state, [sorted(change) for change in changes]))
    return int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "big") % PROVED == 0
