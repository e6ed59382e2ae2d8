"""The instance: what the package's ``.lp`` files take as input, written as ASP facts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files

from tmpud.symbols import Action, State, Transition
from tmpud.task.domain import Domain

DOMAIN = ("driving.lp",)
PLANNING = ("plan.lp", "quality.lp", "show.lp")
REDUCED = ("plan.lp", "reduced.lp", "show.lp")
ENCODING = DOMAIN + PLANNING
PLACES = ("places.lp",)

Weights = Mapping[Transition, int]  # [cm]


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


def steps(domain: Domain, state: State, weights: Weights) -> str:
    """Return the instance of the encoding less ``driving.lp``: what that derives from the facts for these weights."""
    can = (f"can({spelled(step)},{step.next_state.leg},{weight})." for step, weight in weights.items())
    return "\n".join((*can, *_ends(domain, state), ""))


def overs(reduced: Mapping[Transition, tuple[int, int, int]]) -> str:
    """Return what ``reduced.lp`` takes as input beside ``steps``, from centimetres, merges and actions less a way's."""
    return "".join(f"over({spelled(step)},{merges},{actions}).\n" for step, (_, merges, actions) in reduced.items())


def places(domain: Domain, state: State, weights: Weights) -> str:
    """Return what rules may ask for beyond the instance of ``steps``: the goals, and on which lane a segment lies."""
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
