"""Full trials: one that is killed in the middle of its drive, and some that need no drive of their own."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterable
from pathlib import Path

from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.tasks import DONE, SIM_CRASH, Json, Record, Task, results_hash
from tmpud.experiments.running.workers import Limits
from tmpud.experiments.trials.full import FullTrials, Town
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.scene import Control, Scene

PAPER = PAPER_MISSIONS["millbrook"]
STEPS = 300  # of a drive, then its process is killed


class Killed(FullTrials):
    """Full trials, of which one is killed with its simulation as long as the file that it names is there."""

    def run(self, prepared: Town, arguments: Json) -> Json:
        kill = arguments["kill"]
        if kill and Path(kill).exists():
            self._kill_at(STEPS, prepared)
        return super().run(prepared, {"algorithm": arguments["algorithm"]})

    def _kill_at(self, steps: int, town: Town) -> None:
        step, taken = town.simulator.step, iter(range(steps))

        def last(control: Control) -> Scene:
            if next(taken, None) is None:
                os.kill(os.getpid(), signal.SIGKILL)
            return step(control)

        town.simulator.step = last  # type: ignore[method-assign]


def campaign(folder: Path, flag: Path, limits: Limits | None = None) -> list[Record]:
    mission = {"map": "millbrook", "start": PAPER.start, "goal": PAPER.goal, "traffic": 30, "seed": 3}
    tasks = [
        Task(
            key=algorithm,
            work="tests.experiments.trials.test_broken:Killed",
            shared=mission,
            arguments={"algorithm": algorithm, "kill": str(flag) if algorithm == "no-com" else ""},
        )
        for algorithm in ("no-com", "threshold", "tmpud")
    ]
    return list(run_campaign(folder, Experiment(name="broken", options={}), tasks, limits=limits or Limits(jobs=1)))


def statuses(records: Iterable[Record]) -> dict[str, str]:
    return {record.key: record.status for record in records}


def test_a_killed_simulation_costs_its_own_trial_which_the_next_run_makes_up(tmp_path: Path) -> None:
    flag = tmp_path / "kill"
    unbroken = campaign(tmp_path / "unbroken", flag)
    flag.touch()
    assert statuses(campaign(tmp_path / "broken", flag)) == {"no-com": SIM_CRASH, "threshold": DONE, "tmpud": DONE}
    flag.unlink()
    assert results_hash(campaign(tmp_path / "broken", flag)) == results_hash(unbroken)
    assert set(statuses(unbroken).values()) == {DONE}


def test_trials_that_know_of_each_other_end_like_those_that_do_not(tmp_path: Path) -> None:
    together = campaign(tmp_path / "together", tmp_path / "kill")
    alone = campaign(tmp_path / "alone", tmp_path / "kill", Limits(jobs=2, recycle_after=1))
    assert results_hash(together) == results_hash(alone)
