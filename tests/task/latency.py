"""How much CPU time a plan takes: ``python -m tests.task.latency`` prints medians, and nothing tests them."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from statistics import median, quantiles
from time import thread_time
from typing import TypeVar

import clingo

from tests.task.tiny_roads import driven, grid, request
from tmpud.errors import NoPlanError
from tmpud.symbols import OptimisticSafe, State
from tmpud.task.asp_planner import AspPlanner

T = TypeVar("T")


def main(blocks: int = 6, n: int = 200) -> None:
    rng = random.Random(1)
    roads = grid(blocks, rng)
    segments = sorted(roads.segments)
    first: list[float] = []
    replan: list[float] = []
    floor: list[float] = []
    given: list[int] = []
    while len(first) < n:
        start, goal = rng.sample(segments, 2)
        planner, cost, safe = AspPlanner(roads), driven(roads), OptimisticSafe()
        question = (State(start, 0), request(start, goal), cost, safe)
        try:
            elapsed, report = timed(lambda: planner.solve(*question))  # noqa: B023
        except NoPlanError:
            continue
        first.append(elapsed)
        safe[report.plan[0]] = 0.0
        elapsed, report = timed(lambda: planner.solve(*question))  # noqa: B023
        replan.append(elapsed)
        given.append(report.transitions)
        floor.append(timed(one_fact)[0])
    sys.stdout.write(f"{len(roads.lanes)} lanes, {len(segments)} segments, n = {n}, corridor {median(given)}\n")
    for name, times in {"first plan": first, "replan": replan, "one fact": floor}.items():
        p90 = quantiles(times, n=10)[-1]
        sys.stdout.write(f"{name:12} median {median(times) * 1e3:6.2f} ms   p90 {p90 * 1e3:6.2f} ms\n")


def one_fact() -> None:
    """Do what no ASP planner can do without, the floor to compare with."""
    control = clingo.Control(["--warn=none"])
    control.add("base", [], "fact.")
    control.ground([("base", [])])
    control.solve()


def timed(work: Callable[[], T]) -> tuple[float, T]:
    began = thread_time()
    report = work()
    return thread_time() - began, report


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
