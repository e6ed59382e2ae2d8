"""Table I's trials, against what libsumo alone needs for the same steps.

    python -m benchmarks trials --seeds 3

Each round is one seed, in normal and in heavy traffic. ``tmpud`` drives all five algorithms by one worker, as
``tmpud paper table1`` does; ``libsumo`` warms the same towns up, once each, and then only steps them, as often as the
five trials took together. Times are of whole processes, with their start.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from benchmarks.harness import Result, progress
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.tasks import Json, Task
from tmpud.experiments.running.workers import Limits
from tmpud.experiments.trials.grid import cells
from tmpud.experiments.trials.table1 import TRAFFIC, Table1
from tmpud.roads import load_map
from tmpud.runner import Mission
from tmpud.simulators.conventions import DT
from tmpud.simulators.sumo import SumoSimulator

FIRST_SEED = 500
LIBSUMO, OURS = "libsumo", "tmpud (ours)"


class BareTown(SumoSimulator):
    """A town without an ego."""

    def pass_by(self, steps: int) -> None:
        for _ in range(steps):
            self._advance()


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--seeds", type=int, default=3, help="rounds")
    parser.add_argument("--traffic", type=int, nargs="+", default=list(TRAFFIC.values()), help="vehicles in each town")


def measure(asked: argparse.Namespace) -> list[Result]:
    times: dict[str, list[float]] = {LIBSUMO: [], OURS: []}
    steps = []
    for seed in range(FIRST_SEED, FIRST_SEED + asked.seeds):
        progress(f"seed {seed}")
        grid = replace(Table1(trials=1, first_seed=seed).grid(), traffic={f"{n} vehicles": n for n in asked.traffic})
        tasks = [cell.task for cell in cells(grid)]
        before = _spent()
        took = _driven(tasks)
        between = _spent()
        for vehicles in grid.traffic.values():
            shared = next(task.shared for task in tasks if task.shared["traffic"] == vehicles)
            _in_child(shared, sum(took[task.key] for task in tasks if task.shared == shared))
        times[OURS].append(between - before)
        times[LIBSUMO].append(_spent() - between)
        steps.append(sum(took.values()))
    title = f"Table I's five algorithms among {' and '.join(map(str, asked.traffic))} vehicles"
    return [Result(title, LIBSUMO, times, clock="CPU time of whole processes", facts={"steps": steps})]


def _driven(tasks: Sequence[Task]) -> dict[str, int]:
    """Drive the trials and return how many steps each took."""
    with tempfile.TemporaryDirectory() as folder:
        records = run_campaign(Path(folder), Experiment(name="trials", options={}), tasks, limits=Limits(jobs=1))
        return {record.key: round(record.result["travel_time"] / DT) for record in records}


def _in_child(shared: Json, steps: int) -> None:
    process = multiprocessing.get_context("spawn").Process(target=_bare, args=(shared, steps))
    process.start()
    process.join()


def _bare(shared: Json, steps: int) -> None:
    mission = Mission(**shared)
    network = load_map(mission.map)
    request = mission.request(network)
    with BareTown(network, traffic=mission.traffic, seed=mission.seed, request=request) as town:
        town.pass_by(steps)


def _spent() -> float:
    """Return the CPU time of all child processes that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
