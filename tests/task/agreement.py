"""Random road graphs on which clingo, with and without pruning, the search, Dijkstra and enumeration must agree."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass, field

from tests.task.oracle import dijkstra, order, simple_plans, transitions, triple, weight
from tests.task.tiny_roads import random_network
from tmpud.errors import NoPlanError
from tmpud.presets import PRESETS, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Place, ServiceRequest, State, TaskPlan, Transition
from tmpud.task.asp_planner import AspPlanner, PlanReport
from tmpud.task.search_planner import SearchPlanner

BUDGET = 2000  # [steps] where enumeration needs more, Dijkstra alone is compared with
REPLANS = 3


@dataclass
class Tally:
    """What a verification looked at, and what went wrong."""

    graphs: int = 0
    plans: int = 0
    enumerated: int = 0
    without_plan: int = 0
    rounds: int = 0  # the most corridors that a plan took
    mismatches: list[str] = field(default_factory=list)

    def add(self, other: Tally) -> None:
        self.graphs += other.graphs
        self.plans += other.plans
        self.enumerated += other.enumerated
        self.without_plan += other.without_plan
        self.rounds = max(self.rounds, other.rounds)
        self.mismatches += other.mismatches


@dataclass
class Case:
    """One road graph with a request, and weights that change."""

    rng: random.Random
    network: RoadNetwork
    request: ServiceRequest
    preset: Preset
    cost: dict[Transition, float] = field(default_factory=dict)
    safe: dict[Transition, float] = field(default_factory=dict)
    first: dict[Transition, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for step in sorted(transitions(self.network, self.request)):
            self.cost[step] = self.rng.choice((*(10.0, 20.0, 30.0, 25.005) * 3, 0.0, math.inf))
            self.safe[step] = 1.0
        self.first = dict(self.cost)

    def weights(self) -> dict[Transition, int]:
        """Return the weights that count now: no Cost below its first value, but for the literal preset."""
        floor = dict.fromkeys(self.first, 0.0) if self.preset.cost_update == "current pose" else self.first
        costs = {step: max(cost, floor[step]) for step, cost in self.cost.items()}
        return {s: weight(s, c, self.safe[s], self.preset) for s, c in costs.items() if c < math.inf}

    def change(self, state: State) -> None:
        """Estimate some transitions anew, those of the state most of all."""
        for step in sorted(self.cost):
            if self.rng.random() < (0.6 if step.state == state else 0.05):
                self.safe[step] = self.rng.choice((0.0, 0.5, 0.9, 1.0))
            if self.rng.random() < 0.05:
                self.cost[step] *= self.rng.choice((0.5, 1.5, 3.0))


def random_case(rng: random.Random) -> Case:
    network = random_network(rng, rng.choice((2, 3, 4)), rng.choice((4, 5, 6)))
    segments = sorted(network.segments)
    goals = tuple(_goal(rng, segments) for _ in range(rng.choice((1, 1, 2, 3))))
    start = Place("start", (rng.choice(segments),))
    return Case(rng, network, ServiceRequest(start, goals), rng.choice(list(PRESETS.values())))


def _goal(rng: random.Random, segments: list[str]) -> Place:
    chosen = tuple(rng.sample(segments, min(rng.choice((1, 1, 2)), len(segments))))
    return Place("goal", chosen, 5.0 if len(chosen) == 1 and rng.random() < 0.4 else None)


def compare(n: int, seed: int) -> Tally:
    """Compare all planners on ``n`` random graphs, each with a few replans along the plan."""
    tally = Tally()
    for number in range(n):
        case = random_case(random.Random(f"{seed}/{number}"))
        planners = {
            "pruned": AspPlanner(case.network, case.preset),
            "whole map": AspPlanner(case.network, case.preset, prune=False),
            "search": SearchPlanner(case.network, case.preset),
        }
        state = _skipped(case.request, State(case.request.start.segments[0], 0))
        for replan in range(REPLANS):
            plan = _compare_once(case, planners, state, f"graph {seed}/{number}, replan {replan}", tally)
            if plan and case.rng.random() < 0.6:
                state = plan[0].next_state
            case.change(state)
        tally.graphs += 1
    return tally


def _skipped(request: ServiceRequest, state: State) -> State:
    leg = 0
    while (
        leg < len(request.goals) and request.goals[leg].station is None and state.segment in request.goals[leg].segments
    ):
        leg += 1
    return state._replace(leg=leg)


def _compare_once(case: Case, planners: Mapping[str, AspPlanner], state: State, label: str, tally: Tally) -> TaskPlan:
    weights, last = case.weights(), len(case.request.goals)
    found = {name: _solve(planner, state, case) for name, planner in planners.items()}
    expected = dijkstra(state, last, weights)
    plans = simple_plans(state, last, weights, BUDGET)
    tally.plans += 1
    tally.without_plan += expected is None
    for name, report in found.items():
        got = None if report is None else triple(report.plan, weights)
        unproved = report and not report.optimal and name != "search"
        if got != expected or unproved or (got and report and got[0] != report.total_cm):
            tally.mismatches.append(f"{label}, {name}: {got} instead of {expected}")
    if plans is not None:
        tally.enumerated += 1
        best = min(plans, key=lambda plan: (triple(plan, weights), order(plan)), default=None)
        for name, report in found.items():
            if (report and report.plan) != best:
                tally.mismatches.append(f"{label}, {name}: {report and report.plan} instead of {best}")
    first = found["pruned"]
    return first.plan if first else ()


def _solve(planner: AspPlanner, state: State, case: Case) -> PlanReport | None:
    try:
        return planner.solve(state, case.request, case.cost, case.safe)
    except NoPlanError:
        return None
