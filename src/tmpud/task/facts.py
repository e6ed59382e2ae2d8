"""The instance: what the package's ``.lp`` files take as input, written as ASP facts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from importlib.resources import files

from tmpud.symbols import Action, State, Transition
from tmpud.task.corridor import Stretch
from tmpud.task.domain import Domain

DOMAIN = ("driving.lp",)
ENCODING = (*DOMAIN, "plan.lp", "quality.lp", "show.lp")
REDUCED = ("plan.lp", "reduced.lp", "show.lp")
PLACES = ("places.lp",)

Weights = Mapping[Transition, int]  # [cm]
Reduced = tuple[int, int, int]  # centimetres, merges, actions


def encodings() -> tuple[tuple[str, str], ...]:
    """Return name and text of each part of the encoding that comes with the package."""
    return tuple((name, encoding((name,))) for name in ENCODING)


@cache
def encoding(names: tuple[str, ...] = ENCODING) -> str:
    """Return some of the package's ``.lp`` files as one text, by default the whole encoding."""
    return "\n".join(files("tmpud.task").joinpath(name).read_text("utf-8") for name in names)


def facts(domain: Domain, state: State, weights: Weights) -> str:
    """Return the instance of the whole encoding for a plan from a state: roads, goals and weights, one fact a line."""
    lines = dict.fromkeys(fact for transition in weights for fact in _road(domain, transition))
    weighed = (f"weight({spelled(transition)},{weight})." for transition, weight in weights.items())
    return "\n".join((*lines, *_goals(domain), *weighed, *_ends(domain, state), ""))


def choices(domain: Domain, state: State, ranks: Iterable[Transition], reduced: Callable[[Stretch], Reduced]) -> str:
    """Return the instance of ``plan.lp`` and ``reduced.lp`` for a plan from a state along some transitions."""
    lines = []
    for step in ranks:
        name, more = spelled(step), reduced((step,))
        lines.append(f"can({name},{step.next_state.leg},{more[0]}).")
        lines += [f"over({name},{amount},{3 - place})." for place, amount in enumerate(more) if amount or not place]
    return "\n".join((*lines, *_ends(domain, state), ""))


def places(domain: Domain, state: State, weights: Weights) -> str:
    """Return what rules may ask for, too: the goals, and on which lane a segment lies."""
    segments = dict.fromkeys([state.segment, *(step.next_state.segment for step in weights)])
    segments.update(dict.fromkeys(step.state.segment for step in weights))
    lanes = ((segment, domain.network.lanes[domain.network.segments[segment].lane]) for segment in segments)
    rows = (f"lane({quote(segment)},{quote(lane.id)},{quote(lane.edge)})." for segment, lane in lanes)
    return "\n".join((*_goals(domain), *rows, ""))


def spelled(transition: Transition) -> str:
    """Return the arguments that name a transition in every predicate, as clingo spells them, too."""
    (origin, leg), action, (target, _) = transition
    return f"{quote(origin)},{leg},{action},{quote(target)}"


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


def _goals(domain: Domain) -> Iterator[str]:
    for leg, goal in enumerate(domain.request.goals):
        yield from (f"goal({leg},{quote(segment)})." for segment in goal.segments)
        if goal.station is not None:
            yield f"position({leg})."


def _ends(domain: Domain, state: State) -> tuple[str, str]:
    return f"start({quote(state.segment)},{state.leg}).", f"last({domain.last})."
