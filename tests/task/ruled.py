"""Random rules over random road graphs, and what they mean, written out in Python."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

from tests.task.agreement import BUDGET, Case, Tally, random_case
from tests.task.oracle import order, simple_plans, triple
from tmpud.errors import NoPlanError
from tmpud.symbols import State, TaskPlan
from tmpud.task.asp_planner import AspPlanner, PlanReport
from tmpud.task.rules import Rules, read_rules

NONE: tuple[tuple[float, int, int], tuple[()], TaskPlan] = ((math.inf, 0, 0), (), ())
Meaning = Callable[[TaskPlan], float]  # what a rule adds to a plan [cm]; inf: it forbids the plan


@dataclass(frozen=True)
class Ruled:
    """A case under rules."""

    case: Case
    rules: Rules
    meanings: tuple[Meaning, ...]

    def expected(self, state: State) -> tuple[float, TaskPlan] | None:
        """Return total [cm] and plan of the best that the rules allow, by enumeration, (inf, ()) where they allow none.

        None where there are too many plans to look at.
        """
        weights = self.case.weights()
        plans = simple_plans(state, len(self.case.request.goals), weights, BUDGET)
        if plans is None:
            return None
        rows = []
        for plan in plans:
            centimetres, merges, actions = triple(plan, weights)
            total = centimetres + sum(meaning(plan) for meaning in self.meanings)
            rows.append(((total, merges, actions), order(plan), plan))
        (total, *_), _, plan = min((row for row in rows if row[0][0] < math.inf), default=NONE)
        return total, plan

    def solve(self, state: State, *, prune: bool) -> PlanReport | None:
        planner = AspPlanner(self.case.network, self.case.preset, prune=prune, rules=self.rules)
        try:
            return planner.solve(state, self.case.request, self.case.cost, self.case.safe)
        except NoPlanError:
            return None


def random_ruled(rng: random.Random) -> Ruled:
    """Return a case with one or two rules: edges forbidden or made dearer, lanes demanded, merges charged."""
    case = random_case(rng)
    pairs = [_random_rule(rng, case) for _ in range(rng.choice((1, 1, 2)))]
    text = "\n".join(dict.fromkeys(text for text, _ in pairs))
    return Ruled(case, read_rules(text, "rules.lp"), tuple(dict(pairs).values()))


def _random_rule(rng: random.Random, case: Case) -> tuple[str, Meaning]:
    network = case.network
    edge, lane = rng.choice(sorted(network.edges)), rng.choice(sorted(network.lanes))

    def lanes(plan: TaskPlan) -> set[str]:
        return {network.segments[state.segment].lane for step in plan for state in (step.state, step.next_state)}

    def edges(plan: TaskPlan) -> set[str]:
        return {network.lanes[lane].edge for lane in lanes(plan)}

    def merges(plan: TaskPlan) -> int:
        return sum(step.action.is_merge for step in plan)

    cost = rng.choice((500, 2000, 9000, 60_000))
    return rng.choice(
        (
            (f':- onedge("{edge}").', lambda plan: math.inf if edge in edges(plan) else 0.0),
            (f':- not onlane("{lane}").', lambda plan: 0.0 if lane in lanes(plan) else math.inf),
            (f':~ onedge("{edge}"). [{cost}@3, "{edge}"]', lambda plan: cost * (edge in edges(plan))),
            (f"#minimize {{ {cost}@3,S,L : do(S,L,A,_), merge(A) }}.", lambda plan: cost * merges(plan)),
        )
    )


def compare(n: int, seed: int) -> Tally:
    """Compare the pruned planner under random rules with the whole map's and with enumeration."""
    tally = Tally()
    for number in range(n):
        ruled = random_ruled(random.Random(f"rules {seed}/{number}"))
        state = ruled.case.request.start_state()
        tally.graphs += 1
        if state.leg == len(ruled.case.request.goals):
            continue
        ruled.case.change(state)
        ruled.case.first = dict(ruled.case.cost)
        _compare_once(ruled, state, f"rules, graph {seed}/{number}", tally)
    return tally


def _compare_once(ruled: Ruled, state: State, label: str, tally: Tally) -> None:
    pruned, whole = (ruled.solve(state, prune=prune) for prune in (True, False))
    plan = pruned.plan if pruned else ()
    if plan != (whole.plan if whole else ()) or (pruned and not pruned.optimal):
        tally.mismatches.append(f"{label}: {plan} instead of {whole and whole.plan}")
    if expected := ruled.expected(state):
        tally.enumerated += 1
        total = pruned.total_cm + round(pruned.rules_m * 100) if pruned else math.inf
        if (total, plan) != expected:
            tally.mismatches.append(f"{label}: {total}, {plan} instead of {expected}")
    tally.plans += 1
    tally.without_plan += pruned is None
    tally.rounds = max(tally.rounds, pruned.rounds if pruned else 0)
