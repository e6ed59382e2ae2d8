"""The paper's baselines (Sec. V): Algorithm 2 with other lines 5 to 7."""

from __future__ import annotations

from collections.abc import Generator

from tmpud.errors import NoPlanError, RequestError
from tmpud.events import Event
from tmpud.execution.deliberation import Deliberation
from tmpud.execution.tmpud import Communicate, communicate_safety
from tmpud.symbols import TaskPlan


def communicate_nothing(plan: TaskPlan, mind: Deliberation) -> Generator[Event, None, TaskPlan]:  # noqa: ARG001
    """No-communication: every planned action is driven, whatever the traffic does."""
    yield from ()
    return plan


def communicate_refusals(beta: float) -> Communicate:
    """Return Threshold(beta): an action less safe than ``beta`` is refused, and the plan made anew without it."""

    def communicate(plan: TaskPlan, mind: Deliberation) -> Generator[Event, None, TaskPlan]:
        step = plan[0]
        if not mind.estimates(step):
            return plan
        estimate = mind.world.estimate(step)
        yield mind.estimated(step, estimate)
        if estimate.safe >= beta or mind.settled:
            return plan
        mind.known.forbid(step, estimate.safe, mind.world.time)
        reason = f"Safe({step.action}) = {estimate.safe:.2f} < {beta:g}"
        try:
            new_plan = mind.plan(step.state)
        except NoPlanError:
            new_plan = plan if mind.preset.unsafe_fallback == "force" else mind.hold_lane(step.state)
            if not new_plan:
                raise
            reason += ", and no other plan is left: hold the lane"
        if new_plan == plan:
            return plan
        yield from mind.replanned(step, estimate.safe, new_plan, reason)
        return new_plan

    return communicate


ALGORITHMS = ("tmpud", "no-com", "threshold")


def communication(algorithm: str, beta: float) -> Communicate:
    """Return what lines 5 to 7 of Algorithm 2 are for a named algorithm; RequestError for another name."""
    if algorithm == "tmpud":
        return communicate_safety
    if algorithm == "no-com":
        return communicate_nothing
    if algorithm == "threshold":
        return communicate_refusals(beta)
    raise RequestError(f"no algorithm is called {algorithm!r}; there are {', '.join(ALGORITHMS)}")
