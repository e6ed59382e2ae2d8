"""The k best plans without loops (Yen 1971), in the planner's own order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from heapq import heappop, heappush

from tmpud.symbols import State, TaskPlan, Transition
from tmpud.task.corridor import Exit, Search, corridor
from tmpud.task.ties import Taste, taste, walk

Ranked = tuple[int, tuple[Taste, ...], TaskPlan]  # two different plans never compare equal before the third item


def best_plans(search: Search, start: State, count: int) -> list[TaskPlan]:
    """Return up to ``count`` plans, the best first; none of them visits a state twice."""
    waiting = list(_best(search, (), start))
    plans: list[TaskPlan] = []
    while waiting and len(plans) < count:
        plan = heappop(waiting)[2]
        if plan in plans:
            continue
        plans.append(plan)
        for branch in _branches(search, plan, plans):
            heappush(waiting, branch)
    return plans


def _branches(search: Search, plan: TaskPlan, plans: Sequence[TaskPlan]) -> Iterator[Ranked]:
    """Yield the best plans that leave a plan at one of its states and are not among the known ones."""
    for i, step in enumerate(plan):
        root = plan[:i]
        taken = {known[i] for known in plans if len(known) > i and known[:i] == root}
        visited = {earlier.state for earlier in root}
        yield from _best(_without(search, taken, visited), root, step.state)


def _without(search: Search, taken: set[Transition], visited: set[State]) -> Search:
    """Return the same graph less some transitions and states."""

    def out_of(state: State) -> list[Exit]:
        untaken = [way for way in search.out_of(state) if way.transition not in taken]
        return [way for way in untaken if way.transition.next_state not in visited]

    return replace(search, out_of=out_of)


def _best(search: Search, root: TaskPlan, start: State) -> Iterator[Ranked]:
    """Yield the best plan that begins with ``root`` and goes on from ``start``, where there is one."""
    found = corridor(search, start)
    if found is not None:
        plan = root + walk(start, found.optimal_transitions())
        yield sum(map(search.utility.rank, plan)), tuple(map(taste, plan)), plan
