"""Why a plan was changed: in words, and as the plans to choose from with their terms before and after."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from tmpud.events import Estimated, Planned, Refused
from tmpud.story import plan_name
from tmpud.symbols import Action, TaskPlan, Transition
from tmpud.task.utility import penalty
from tmpud.viewer.memory import Memory

WORDS = {
    Action.MERGELEFT: ("merge left", "merging left"),
    Action.MERGERIGHT: ("merge right", "merging right"),
    Action.FORWARD: ("go straight on", "going straight on"),
    Action.TURNLEFT: ("turn left", "turning left"),
    Action.TURNRIGHT: ("turn right", "turning right"),
}


@dataclass(frozen=True, slots=True)
class Candidate:
    """A plan that could be chosen: its length, and its safety term before and after the estimate [m]."""

    plan: TaskPlan
    role: str  # "given up", "chosen" or ""
    length: float | None  # None: not known
    turns: float
    before: float
    after: float | None  # None: it may not be driven any more

    @property
    def total(self) -> float | None:
        return None if self.length is None or self.after is None else self.length + self.turns + self.after


@dataclass(frozen=True, slots=True)
class Change:
    """One change of plan, explained."""

    number: int  # of the new plan
    step: Transition | None  # the action that was refused
    headline: str
    words: tuple[str, ...]
    keep: tuple[str, ...]  # what would have had to be true to keep the old plan
    candidates: tuple[Candidate, ...]


@dataclass(slots=True)
class Situation:
    """What was the case when a new plan was taken up."""

    number: int  # of the new plan
    new: Planned
    done: TaskPlan  # what was driven of the old plan ...
    rest: TaskPlan  # ... and what was left of it
    road: str  # on which the refused action begins, as people call it
    listed: tuple[TaskPlan, ...]  # the plans listed beside the old one
    estimate: Estimated | None  # of the first action left
    refused: Refused | None
    memory: Memory
    old_safe: float = 1.0  # what Safe of that action was taken to be before
    forbidden: bool = field(init=False)  # whether that action may not be driven any more

    def __post_init__(self) -> None:
        barred = self.new.reason.endswith("cannot be driven from here")
        self.forbidden = barred or (self.refused is not None and "<" in self.refused.reason)


def explain(case: Situation) -> Change:
    """Explain one change of plan."""
    candidates = _candidates(case)
    if case.refused is None or not case.rest:
        return Change(case.number, None, case.new.reason, _other(case), (), candidates)
    step = case.refused.step
    headline = f"{WORDS[step.action][1]} was not safe enough: Safe = {case.refused.safe:.2f}"
    words = (*_estimated(case), *_weighed(case, candidates))
    return Change(case.number, step, headline, words, tuple(_keep(case, candidates)), candidates)


def _candidates(case: Situation) -> tuple[Candidate, ...]:
    """Return the old plan, the new one and those that were listed beside either, the best first."""
    follow_on = [plan[len(case.done) :] for plan in case.listed if plan[: len(case.done)] == case.done]
    listed = [case.rest, case.new.plan, *(plan for plan, _, _ in case.new.alternatives), *follow_on]
    found = [_candidate(case, plan) for plan in dict.fromkeys(plan for plan in listed if plan)]
    return tuple(sorted(found, key=_order))


def _order(candidate: Candidate) -> tuple[bool, float, bool]:
    return candidate.total is None, round(candidate.total or 0.0, 2), candidate.role != "chosen"


def _candidate(case: Situation, plan: TaskPlan) -> Candidate:
    memory, now = case.memory, case.new.time
    first = case.rest[0] if case.rest else None
    after = memory.penalty(plan, now)
    before = after
    if case.estimate is not None and first in plan:
        before += penalty(case.old_safe, memory.preset) - penalty(case.estimate.safe, memory.preset)
    barred = case.forbidden and first in plan
    role = "chosen" if plan == case.new.plan else "given up" if plan == case.rest else ""
    length = memory.length(plan) or memory.length(plan, case.done)
    return Candidate(plan, role, length, memory.turns(plan), before, None if barred else after)


def _estimated(case: Situation) -> Iterator[str]:
    assert case.refused is not None  # noqa: S101 - told by the caller
    infinitive, gerund = WORDS[case.refused.step.action]
    yield f"Plan {plan_name(case.number - 1)} was to {infinitive} now, on {case.road}."
    risk = case.estimate.worst if case.estimate else None
    who = f" The vehicle that limits it most is {risk}, marked on the map." if risk else ""
    yield (
        f"Before it starts an action the car estimates how safe that would be in the traffic around it. "
        f"For {gerund} it found Safe = {case.refused.safe:.2f} (1: every control stays safe; 0: none does).{who}"
    )


def _weighed(case: Situation, candidates: tuple[Candidate, ...]) -> Iterator[str]:
    old, new = (next((c for c in candidates if c.role == role), None) for role in ("given up", "chosen"))
    names = plan_name(case.number - 1), plan_name(case.number)
    if case.forbidden:
        yield f"That is too little for this driver: {case.new.reason}. It looks for the best plan without that action."
    elif old and new and old.length is not None and new.length is not None and old.after is not None:
        yield (
            f"A low Safe counts like a detour: it adds {old.after - old.before:,.0f} m to plan {names[0]}, which so "
            f"costs {_sum(old)}. Plan {names[1]} costs {_sum(new)}. "
            f"The car always takes the cheapest plan, so it changed to plan {names[1]}."
        )
    else:
        yield f"With that plan {names[1]} was better: {case.new.reason}."


def _sum(candidate: Candidate) -> str:
    length = (candidate.length or 0.0) + candidate.turns
    return f"{length:,.0f} m of road + {candidate.after:,.0f} m of penalty = {candidate.total:,.0f} m"


def _keep(case: Situation, candidates: tuple[Candidate, ...]) -> Iterator[str]:
    """Yield what would have had to be true to keep the old plan, one thing changed at a time."""
    old, new = (next((c for c in candidates if c.role == role), None) for role in ("given up", "chosen"))
    if case.forbidden or case.refused is None or old is None or new is None:
        return
    if old.total is None or new.total is None or old.after is None or case.refused.step in new.plan:
        return
    name, hysteresis = plan_name(case.number), case.memory.preset.hysteresis
    room = new.total + hysteresis - old.total  # negative: by so much the old plan was worse
    least = case.memory.least_safe(penalty(case.refused.safe, case.memory.preset) + room)
    gerund = WORDS[case.refused.step.action][1]
    if least is not None:
        yield f"{gerund} had been safer: Safe of at least {_share(least)} instead of {case.refused.safe:.2f}"
    yield f"or plan {name} had been at least {-room:,.0f} m longer ({(new.length or 0.0) - room:,.0f} m of road)"


def _share(safe: float) -> str:
    return f"{safe:.2f}" if safe < 0.995 else "0.999 (next to no risk)" if safe < 1.0 else "1"


def _other(case: Situation) -> tuple[str, ...]:
    """Say why a plan was made anew where no action was refused."""
    name, reason = plan_name(case.number - 1), case.new.reason
    if reason == "the lane was held":
        return (f"Plan {name} was only to hold the lane; at its end the car made a new one.",)
    if case.forbidden:
        return (f"No path does the next action of plan {name} from where the car stood: {reason}.",)
    return (f"Plan {name} was given up: {reason}.",)
