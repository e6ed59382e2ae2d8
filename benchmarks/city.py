"""What maps of a city's size cost: reading, reading again, the first plan to a goal, and replans after a Safe update.

    python -m benchmarks.city --maps grid:12:2 grid:36:2 grid:147:2 --starts 100

Maps are named as in the benchmark ``plan``; ``sumo:game/DRT/osm`` is a real one that comes with SUMO. Costs are the
motion planner's path lengths. Times are CPU seconds; the cache is one of its own.
"""

from __future__ import annotations

import argparse
import random
import resource
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from statistics import median
from typing import TypeVar

from benchmarks.nets import net_file
from tmpud.errors import NoPlanError
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import TMPUD
from tmpud.roads.cache import read_cached
from tmpud.roads.network import SEGMENT_LENGTH, RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.symbols import LazyCost, OptimisticSafe, Place, ServiceRequest, State
from tmpud.task.asp_planner import AspPlanner, PlanReport

T = TypeVar("T")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--maps", nargs="+", default=["grid:12:2", "grid:36:2"])
    parser.add_argument("--starts", type=int, default=100, help="random starts, with a replan from each")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    for name in asked.maps:
        with net_file(name) as net, tempfile.TemporaryDirectory() as cache:
            _say(name)
            for stage in (_reading, _reading_again, partial(_planning, starts=asked.starts, seed=asked.seed)):
                # each in a process of its own, which has its own peak of memory
                process = get_context("fork").Process(target=stage, args=(net, Path(cache)))
                process.start()
                process.join()


def _load(net: Path, cache: Path) -> RoadNetwork:
    return read_cached(net, SEGMENT_LENGTH, partial(read_sumo_net, segment_length=SEGMENT_LENGTH), cache, 0)


def _reading(net: Path, cache: Path) -> None:
    elapsed, network = _timed(lambda: read_sumo_net(net))
    _say(f"  {len(network.lanes):,} lanes, {len(network.segments):,} segments, {net.stat().st_size / 1e6:.0f} MB")
    _say(f"  reading {elapsed:.2f} s, peak memory {_peak():.0f} MB")
    _load(net, cache)


def _reading_again(net: Path, cache: Path) -> None:
    elapsed, _ = _timed(lambda: _load(net, cache))
    _say(f"  reading it again, from the cache, {elapsed:.2f} s, peak memory {_peak():.0f} MB")


def _planning(net: Path, cache: Path, starts: int, seed: int) -> None:
    rng = random.Random(seed)  # noqa: S311  repeatable, no secret
    network = _load(net, cache)
    segments = sorted(network.segments)
    planner, safe = AspPlanner(network, TMPUD), OptimisticSafe()
    report = None
    while report is None:  # real maps have ways in that lead to few other places
        home, goal = rng.sample(segments, 2)
        request = ServiceRequest(Place("start", (home,)), (Place("goal", (goal,)),))
        cost = LazyCost(PathPlanner(network, StateMapping(network, request, TMPUD)).path_length)
        with suppress(NoPlanError):
            first, report = _timed(partial(planner.solve, State(home, 0), request, cost, safe))
    _say(f"  first plan {first:.2f} s, {len(report.plan)} actions, peak memory {_peak():.0f} MB")
    times: list[float] = []
    replans: list[PlanReport] = []
    while len(times) < starts:
        state = State(rng.choice(segments), 0)
        with suppress(NoPlanError, IndexError):
            safe[planner.solve(state, request, cost, safe).plan[0]] = 0.3
            elapsed, replan = _timed(partial(planner.solve, state, request, cost, safe))
            times.append(elapsed)
            replans.append(replan)
    times.sort()
    p99 = times[int(len(times) * 0.99)]
    _say(f"  replan median {median(times) * 1e3:.2f} ms, p99 {p99 * 1e3:.2f} ms, n = {len(times)}")
    ground, solve = (median(getattr(r, name) for r in replans) * 1e3 for name in ("ground_s", "solve_s"))
    size, actions = (median(counts) for counts in zip(*((r.transitions, len(r.plan)) for r in replans), strict=True))
    _say(
        f"    of it clingo {ground:.2f} + {solve:.2f} ms (wall); corridor {size:.0f} transitions, {actions:.0f} actions"
    )


def _timed(work: Callable[[], T]) -> tuple[float, T]:
    began = time.thread_time()
    result = work()
    return time.thread_time() - began, result


def _peak() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0  # [MB]


def _say(line: str) -> None:
    print(line, flush=True)


if __name__ == "__main__":
    main()
