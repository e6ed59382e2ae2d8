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
    ways: dict[State, list[Transition]] = {}
    for transition in sorted(union, key=taste):
        ways.setdefault(transition.state, []).append(transition)
    state = start
    while state in ways and len(ways[state]) == 1:
        state = ways[state][0].next_state
    return ways[state][0] if state in ways else None


def walk(start: State, union: Iterable[Transition]) -> TaskPlan:
    """Return the preferred plan among all that the union of optimal plans holds; they all have the same rank."""
    preferred: dict[State, Transition] = {}
    for transition in sorted(union, key=taste):
        preferred.setdefault(transition.state, transition)
    plan, state = [], start
    while state in preferred:
        plan.append(preferred[state])
        state = preferred[state].next_state
    return tuple(plan)
