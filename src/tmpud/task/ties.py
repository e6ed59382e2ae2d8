"""Which of several equally good plans is taken: the earliest merge, then the smallest lane id."""

from __future__ import annotations

from collections.abc import Iterable

from tmpud.symbols import Action, State, TaskPlan, Transition

Taste = tuple[bool, str, Action, int]


def taste(transition: Transition) -> Taste:
    """Return what orders the transitions of one state: a merge comes first, then the smallest next segment."""
    return not transition.action.is_merge, transition.next_state.segment, transition.action, transition.next_state.leg


def preferred(start: State, union: Iterable[Transition]) -> Transition | None:
    """Return the preferred transition of the first state on the walk that has several; None where it has no choice."""
    ways, state = _ways(union), start
    while len(here := ways.get(state, [])) == 1:
        state = here[0].next_state
    return min(here, key=taste, default=None)


def walk(start: State, union: Iterable[Transition]) -> TaskPlan:
    """Return the preferred plan among all that the union of optimal plans holds; they all have the same rank."""
    ways, plan, state = _ways(union), list[Transition](), start
    while here := ways.get(state):
        plan.append(here[0] if len(here) == 1 else min(here, key=taste))
        state = plan[-1].next_state
    return tuple(plan)


def _ways(union: Iterable[Transition]) -> dict[State, list[Transition]]:
    found: dict[State, list[Transition]] = {}
    for transition in union:
        found.setdefault(transition.state, []).append(transition)
    return found
