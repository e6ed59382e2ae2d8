"""Abstract trials: plans by A*, remembered, as the experiments have them, beside plans that clingo proves.

    python -m benchmarks abstract --trials 250 --rounds 4

Each round is some trials of the paper's mission under one road condition. All must end alike: where, after how many
metres, and how.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from benchmarks.harness import Entry, Result, progress, race
from tmpud.experiments.running.tasks import Json
from tmpud.experiments.statistics.paper_numbers import FIGURE4
from tmpud.experiments.trials.abstract import AbstractTrials, Ground, Way
from tmpud.experiments.trials.figure4 import PER_TRIAL, Figure4
from tmpud.experiments.trials.plan_memory import PlanMemory
from tmpud.symbols import Cost, Safe, ServiceRequest, State
from tmpud.task.asp_planner import AspPlanner, PlanReport
from tmpud.task.search_planner import SearchPlanner

REMEMBERED, PROVED, ALWAYS = "A*, plans remembered (ours)", "clingo, plans remembered", "clingo, every plan anew"
ENDS = ("SUCCESS", "COLLISION", "STOPPED_BLOCKED", "TIME_LIMIT", "NO_PLAN", "INVALID_STATE")


class Prover(SearchPlanner):
    """Has every plan proved by clingo."""

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        return AspPlanner.solve(self, state, request, cost, safe)


class Forgetful(PlanMemory):
    """Remembers no plan."""

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        self.begin()
        self._plans.clear()
        return super().solve(state, request, cost, safe)


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--algorithm", default="tmpud")
    parser.add_argument("--trials", type=int, default=250, help="of a round")
    parser.add_argument("--rounds", type=int, default=4, help="they take turns among the road conditions")


def measure(asked: argparse.Namespace) -> list[Result]:
    shared = Figure4().tasks()[0].shared
    ground = AbstractTrials().prepare(shared)
    conditions = list(FIGURE4)
    cases = [
        {
            "condition": conditions[n % len(conditions)],
            "algorithm": asked.algorithm,
            "beta": 0.0,
            "draws": f"benchmark/{n}",
            "first": 0,
            "count": asked.trials,
        }
        for n in range(asked.rounds)
    ]
    progress(f"abstract: {asked.rounds} rounds of {asked.trials} trials")
    makers: dict[str, Callable[[Way], PlanMemory]] = {
        REMEMBERED: lambda way: PlanMemory(SearchPlanner(way.domain.network), way.length),
        PROVED: lambda way: PlanMemory(Prover(way.domain.network), way.length),
        ALWAYS: lambda way: Forgetful(Prover(way.domain.network), way.length),
    }
    times = race([_entry(name, make, ground) for name, make in makers.items()], cases)
    facts = {"map": shared["map"], "preset": shared["preset"], "algorithm": asked.algorithm, "trials": asked.trials}
    return [Result(f"{asked.trials} abstract trials of {asked.algorithm}", REMEMBERED, times, facts=facts)]


def _entry(name: str, make: Callable[[Way], PlanMemory], ground: Ground) -> Entry[dict[str, Any]]:
    def pose(case: dict[str, Any]) -> Callable[[], list[float]]:
        ways = tuple(replace(way, planner=make(way)) for way in ground.ways)
        return lambda: _numbers(AbstractTrials().run(ground._replace(ways=ways), case))

    return Entry(name, pose)


def _numbers(result: Json) -> list[float]:
    """Return how each trial ended, in numbers."""
    ends: list[float] = [ENDS.index(status) for status in result["status"]]
    return ends + [value for name in PER_TRIAL if name != "status" for value in result[name]]
