"""What Algorithm 2 has in mind while it runs: the request, what is known, how often it changed its mind."""

from __future__ import annotations

import math
from collections.abc import Generator

from tmpud.errors import NoPlanError
from tmpud.events import Estimated, Event, Executed, Planned, Refused
from tmpud.execution.knowledge import Knowledge
from tmpud.execution.records import estimated
from tmpud.presets import Preset
from tmpud.protocols import PathLengths, TaskPlanner, World
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Outcome
from tmpud.symbols import Action, ServiceRequest, State, TaskPlan, Transition
from tmpud.task.domain import Domain
from tmpud.task.utility import Utility, penalty

ALTERNATIVES = 4  # other plans that are listed beside the best one


class Deliberation:
    """Shared by the loop and by what lines 5 to 7 are for each algorithm."""

    def __init__(
        self,
        request: ServiceRequest,
        domain: Domain,
        planner: TaskPlanner,
        motion: PathLengths,
        world: World,
        *,
        alternatives: int = ALTERNATIVES,
    ) -> None:
        """``domain`` is asked only for what can be done in a state when no plan is left."""
        self.request, self.domain, self.planner, self.world = request, domain, planner, world
        self.preset: Preset = planner.preset
        self._alternatives = alternatives
        self.known = Knowledge(motion.path_length, self.preset)
        self.replans = 0
        self._motion_length = motion.path_length
        self._tried: list[TaskPlan] = []  # plans given up since the car last moved

    def plan(self, state: State) -> TaskPlan:
        """Return P^t(s, s^g, Cost, Safe); raises NoPlanError."""
        self.known.forget(self.world.time)
        return self.planner.solve(state, self.request, self.known.cost, self.known.safe).plan

    def estimates(self, step: Transition) -> bool:
        """Whether the motion level judges this action: where the preset says so and a path does it."""
        wanted = self.preset.estimated == "every action" or step.action.is_merge
        return wanted and math.isfinite(self.world.path_length(step))

    def is_better(self, new: TaskPlan, old: TaskPlan) -> bool:
        """Whether a plan is worth changing to: better by the hysteresis, or the old one cannot be driven."""
        if new == old:
            return False
        utility = Utility(self.preset, self.known.cost, self.known.safe, {})
        new_sum, old_sum = (sum(utility.total(plan).terms) for plan in (new, old))
        return old_sum - new_sum >= self.preset.hysteresis - 1e-9

    @property
    def settled(self) -> bool:
        """Whether the plan changed so often without motion that it stays as it is until the car has moved."""
        return len(self._tried) >= self.preset.max_replans

    def change(self, plan: TaskPlan, new_plan: TaskPlan) -> Generator[Event, None, TaskPlan]:
        """Return the plan that takes a plan's place: the new one, or at last the most conservative of all."""
        self._tried.append(plan)
        if not self.settled:
            return new_plan
        chosen = self.most_conservative([*self._tried, new_plan])
        if chosen != new_plan:
            count = len(self._tried)
            yield self.planned(chosen, f"of {count + 1} plans since the car moved it is the most conservative")
        return chosen

    def most_conservative(self, plans: list[TaskPlan]) -> TaskPlan:
        """Return the drivable plan that risks least: the least penalty above that of Safe = 1; the latest of equals."""
        return min(reversed(plans), key=self._risk)

    def _risk(self, plan: TaskPlan) -> float:
        if any(math.isinf(self.known.cost[step]) for step in plan):
            return math.inf
        return sum(penalty(self.known.safe[step], self.preset) - penalty(1.0, self.preset) for step in plan)

    def drop_first(self, plan: TaskPlan) -> Generator[Event, None, TaskPlan]:
        """Return the rest of a plan; where it ended short of the goal, as holding a lane does, plan anew."""
        self._tried.clear()
        here = plan[0].next_state
        if plan[1:] or self.domain.is_goal(here):
            return plan[1:]
        new_plan = self.plan_or_hold(here)
        yield self.planned(new_plan, "the lane was held")
        return new_plan

    def bar(self, step: Transition) -> Generator[Event, None, TaskPlan]:
        """Return the plan after a step turned out to have no path from where the ego is."""
        self.replans += 1
        self.known.forbid(step, self.known.safe[step], self.world.time)
        new_plan = self.plan_or_hold(step.state)
        yield self.planned(new_plan, f"{step.action} cannot be driven from here")
        return new_plan

    def plan_or_hold(self, state: State) -> TaskPlan:
        """Return P^t's plan, or where it has none one step that keeps the lane; NoPlanError where the lane ends."""
        try:
            return self.plan(state)
        except NoPlanError:
            if held := self.hold_lane(state):
                return held
            raise

    def hold_lane(self, state: State) -> TaskPlan:
        """Return one step that keeps the lane, or follows it through a junction; none where the lane ends.

        What was refused as unsafe is driven all the same: there is nothing else to do in a lane.
        """
        ways = [way for way in self.domain.successors(state) if not way.action.is_merge]
        drivable = [way for way in ways if self._motion_length(way) < math.inf]
        return tuple(sorted(drivable, key=lambda way: (way.action is not Action.FORWARD, way.next_state))[:1])

    # Events ----------------------------------------------------------------------------------------------------

    def planned(self, plan: TaskPlan, reason: str) -> Planned:
        """Return the record of a plan that is taken up, beside the next best ones."""
        start = plan[0].state if plan else self.domain.start_state()
        cost, safe = self.known.cost, self.known.safe
        utility = Utility(self.preset, cost, safe, {})
        terms = [utility.terms(step) for step in plan]
        count = self._alternatives
        others = self.planner.alternatives(start, self.request, cost, safe, count) if count else ()
        others = tuple(other for other in others if other.plan != plan)
        return Planned(
            time=self.world.time,
            leg=start.leg,
            plan=plan,
            cost=tuple(term.cost for term in terms),
            penalty=tuple(term.penalty for term in terms),
            alternatives=tuple((other.plan, other.cost_m, other.penalty_m) for other in others),
            reason=reason,
        )

    def estimated(self, step: Transition, estimate: SafetyEstimate) -> Estimated:
        """Return the record of an estimate."""
        return estimated(self.world.time, step, estimate)

    def executed(self, step: Transition, outcome: Outcome, estimated: bool) -> Executed:
        """Return the record of an action that was driven."""
        return Executed(self.world.time, step, outcome.value, estimated, self.world.distance)

    def replanned(self, step: Transition, safe: float, plan: TaskPlan, reason: str) -> Generator[Event, None, None]:
        """Yield the records of an action refused and of the plan that takes its place."""
        self.replans += 1
        yield Refused(self.world.time, step, safe, reason)
        yield self.planned(plan, reason)
