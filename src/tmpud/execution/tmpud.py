"""Algorithm 2: task-motion planning for urban driving. A reader starts here.

The loop plans, lets the motion level judge the first action, plans again with what it said, and drives the action only
if the plan has not changed. What lines 5 to 7 do is passed in, so that the paper's baselines (``baselines.py``) share
the rest of the loop.
"""

from __future__ import annotations

from collections.abc import Callable, Generator

from tmpud.events import Event
from tmpud.execution.deliberation import Deliberation
from tmpud.scene import Outcome
from tmpud.symbols import State, TaskPlan

Communicate = Callable[[TaskPlan, Deliberation], Generator[Event, None, TaskPlan]]


def run_tmpud(start: State, mind: Deliberation, communicate: Communicate) -> Generator[Event, None, Outcome]:
    """Drive a service request: yield what happens, return how it ends.

    Raises NoPlanError where no plan reaches the goal, at the start or later.
    """
    # Lines 1 and 2: Cost <- A*(x, x') and Safe <- 1.0, each when it is first asked for
    # Line 3
    plan = mind.plan(start)
    yield mind.planned(plan, "start")
    # Line 4
    while plan:
        step = plan[0]
        # Lines 5 to 7
        new_plan = yield from communicate(plan, mind)
        # Line 8
        if new_plan == plan:
            # Lines 9 to 14
            estimated = mind.world.is_estimated(step)
            outcome = yield from mind.world.execute(step, plan[1:])
            yield mind.executed(step, outcome, estimated)
            if outcome is Outcome.INFEASIBLE:
                plan = yield from mind.bar(step)
            elif outcome is not Outcome.DONE:
                return outcome
            else:
                # Line 15
                plan = yield from mind.drop_first(plan)
        else:
            # Line 17
            plan = yield from mind.change(plan, new_plan)
    return Outcome.DONE


def communicate_safety(plan: TaskPlan, mind: Deliberation) -> Generator[Event, None, TaskPlan]:
    """Let the motion level tell the task level about the plan's first action (Alg. 2, lines 5 to 7)."""
    step = plan[0]
    if not mind.estimates(step):
        return plan
    # Line 5
    estimate = mind.world.estimate(step)
    yield mind.estimated(step, estimate)
    # Line 6
    mind.known.learn(step, estimate.safe, mind.world.path_length(step), mind.world.time)
    if mind.settled:
        return plan
    # Line 7
    new_plan = mind.plan(step.state)
    if not mind.is_better(new_plan, plan):
        return plan
    yield from mind.replanned(step, estimate.safe, new_plan, f"Safe({step.action}) = {estimate.safe:.2f}")
    return new_plan
