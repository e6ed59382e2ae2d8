"""The instance: what ``driving.lp`` and ``quality.lp`` take as input, written as ASP facts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files

from tmpud.symbols import Action, State, Transition
from tmpud.task.domain import Domain

ENCODING = ("driving.lp", "quality.lp", "show.lp")


@cache
def encodings() -> tuple[tuple[str, str], ...]:
    """Return name and text of each part of the encoding that comes with the package."""
    return tuple((name, files("tmpud.task").joinpath(name).read_text("utf-8")) for name in ENCODING)


@cache
def encoding() -> str:
    """Return the whole encoding."""
    return "\n".join(text for _, text in encodings())


def facts(domain: Domain, state: State, weights: Mapping[Transition, int]) -> str:
    """Return the instance for a plan from a state over the transitions that have a weight [cm], one fact a line."""
    lines = dict.fromkeys(fact for transition in weights for fact in _road(domain, transition))
    weighed = (_weight(transition, weight) for transition, weight in weights.items())
    return "\n".join((*lines, *_request(domain), *weighed, f"start({quote(state.segment)},{state.leg}).", ""))


def quote(text: str) -> str:
    """Return any text as an ASP string."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def _road(domain: Domain, transition: Transition) -> Iterator[str]:
    """Yield the facts about the roads that allow a transition."""
    network, action = domain.network, transition.action
    origin, target = transition.state.segment, transition.next_state.segment
    if action.is_merge:
        before = network.behind(target)
        beside = before.id if before and not network.uncut else target
        left, right = (beside, origin) if action is Action.MERGELEFT else (origin, beside)
        yield f"leftof({quote(left)},{quote(right)})."
        yield f"uncut({quote(origin)})." if network.uncut else f"ahead({quote(target)},{quote(beside)})."
        return
    following = network.ahead(origin)
    if following is not None and following.id == target:
        yield f"ahead({quote(target)},{quote(origin)})."
    elif following is None and any(
        connection.to_lane == network.segments[target].lane and connection.action is action
        for connection in network.outgoing(network.segments[origin].lane)
    ):
        yield f"connected({quote(origin)},{action},{quote(target)})."


def _request(domain: Domain) -> Iterator[str]:
    for leg, goal in enumerate(domain.request.goals):
        yield from (f"goal({leg},{quote(segment)})." for segment in goal.segments)
        if goal.station is not None:
            yield f"position({leg})."
    yield f"last({domain.last})."


def _weight(transition: Transition, weight: int) -> str:
    (origin, leg), action, (target, _) = transition
    return f"weight({quote(origin)},{leg},{action},{quote(target)},{weight})."
