"""Why there is no plan: which goal is cut off, and by what."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmpud.symbols import State, Transition
from tmpud.task.domain import Domain
from tmpud.task.utility import FORBIDDEN

NAMED = 3  # so many are named, the rest are counted


def explain(domain: Domain, start: State, rank: Callable[[Transition], int]) -> str:
    """Return one line: the leg and goal that are cut off, how much can be reached, and what is in the way."""
    reached = _reachable(domain, start, rank)
    leg = max(state.leg for state in reached)
    here = {state for state in reached if state.leg == leg}
    goal = domain.request.goals[leg]
    before = _leading_to(domain, leg)
    place = f"leg {leg + 1} of {domain.last}: goal {goal.name} is cut off from {start.segment}"
    extent = f"{len(here)} segment{'s' * (len(here) != 1)} can be reached"
    return f"{place}; {extent}; {_cause(domain, here, before, rank)}"


def _cause(domain: Domain, here: set[State], before: set[State], rank: Callable[[Transition], int]) -> str:
    leaving = [transition for state in sorted(here) for transition in domain.successors(state)]
    barred = [transition for transition in leaving if rank(transition) >= FORBIDDEN]
    cut = [t for t in barred if t.next_state in before or t.next_state.leg > t.state.leg]
    if cut:
        return f"forbidden: {_few(f'{t.action} from {t.state.segment} to {t.next_state.segment}' for t in cut)}"
    if not leaving:
        return f"nothing leads out of {_few(state.segment for state in sorted(here))}"
    if not before:
        return "nothing leads to the goal"
    entries = sorted({domain.network.segments[state.segment].lane for state in before})
    return f"nothing leads from there to the lanes before the goal: {_few(entries)}"


def _reachable(domain: Domain, start: State, rank: Callable[[Transition], int]) -> set[State]:
    """Return the states that can be driven to, the start among them."""
    reached, ahead = {start}, [start]
    while ahead:
        for transition in domain.successors(ahead.pop()):
            if rank(transition) < FORBIDDEN and transition.next_state not in reached:
                reached.add(transition.next_state)
                ahead.append(transition.next_state)
    return reached


def _leading_to(domain: Domain, leg: int) -> set[State]:
    """Return the states of a leg from which its goal can be reached on the map, forbidden or not."""
    goals = [State(segment, domain.leg_after(segment, leg)) for segment in domain.request.goals[leg].segments]
    found, ahead = set[State](), goals
    while ahead:
        for transition in domain.predecessors(ahead.pop()):
            if transition.state.leg == leg and transition.state not in found:
                found.add(transition.state)
                ahead.append(transition.state)
    return found


def _few(names: Iterable[str]) -> str:
    every = list(dict.fromkeys(names))
    more = f" and {len(every) - NAMED} more" if len(every) > NAMED else ""
    return ", ".join(every[:NAMED]) + more
