"""Tasks that crash, hang or answer nonsense among others that do not: each must cost itself only."""

from __future__ import annotations

import os
import random
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.experiments.running.works import Quick, task
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.tasks import DONE, SIM_CRASH, SIM_HANG, Json, Record, Task
from tmpud.experiments.running.workers import Limits

LIMIT = 0.5  # [s] for a task
ENDS = {"crash": SIM_CRASH, "exit": SIM_CRASH, "leave": SIM_CRASH, "garbage": SIM_CRASH, "hang": SIM_HANG}
GROUP = 10


@dataclass(slots=True)
class Tally:
    """What became of tasks that misbehave and of their neighbours; but for the first two all are to be 0."""

    bad: int = 0
    good: int = 0
    wrong_status: int = 0  # of those that misbehave
    harmed: int = 0  # neighbours with another result than they have alone
    left: int = 0  # processes still there when the record came, or at the end
    latest: float = 0.0  # [s] after a task's limit until its record came; about 0
    notes: list[str] = field(default_factory=list)


class Noted(Quick):
    """Notes its process before it misbehaves, and that of a child it leaves when it is about to hang."""

    def run(self, prepared: list[int], arguments: Json) -> Json:
        if "note" in arguments:
            child = 0
            if arguments["how"] == "hang" and not (child := os.fork()):
                time.sleep(3600.0)
            with Path(arguments["note"]).open("a") as note:
                note.write(f"{time.time()} {os.getpid()} {child or os.getpid()}\n")
        return super().run(prepared, arguments)


class NotedIsolated(Noted):
    isolated = True


def misbehave(number: int, seed: int) -> Tally:
    """Run as many tasks that misbehave as others, in groups of both, in the worker and in copies of it."""
    tally = Tally()
    with tempfile.TemporaryDirectory() as parent:
        tasks = _mixed(number, seed, Path(parent))
        experiment = Experiment(name="faults", options={})
        for record in run_campaign(Path(parent) / "all", experiment, tasks, limits=Limits(jobs=4, task=LIMIT)):
            _judge(record, Path(parent) / record.key, tally)
        tally.left += sum(map(_alive, _noted(Path(parent).glob("bad*"))))
    return tally


def _mixed(number: int, seed: int, folder: Path) -> list[Task]:
    rng = random.Random(seed)
    tasks = [task(f"good-{n}", seed=n) for n in range(number)] + [
        task(f"bad-{how}-{n}", note=str(folder / f"bad-{how}-{n}"), how=how)
        for n in range(number)
        for how in [list(ENDS)[n % len(ENDS)]]
    ]
    rng.shuffle(tasks)
    return [
        Task(
            key=one.key,
            work=f"tests.experiments.running.faults:{'NotedIsolated' if n // GROUP % 2 else 'Noted'}",
            shared={"town": n // GROUP},
            arguments=one.arguments,
        )
        for n, one in enumerate(tasks)
    ]


def _judge(record: Record, note: Path, tally: Tally) -> None:
    kind, _, rest = record.key.partition("-")
    if kind == "good":
        tally.good += 1
        harmed = record.status != DONE or record.result["text"].split()[1] != rest
        tally.harmed += harmed
        tally.notes += [f"{record}"] * harmed
        return
    tally.bad += 1
    wrong = record.status != ENDS[rest.partition("-")[0]]
    tally.wrong_status += wrong
    tally.notes += [f"{record}"] * wrong
    began = float(note.read_text().splitlines()[-1].split()[0])
    tally.latest = max(tally.latest, time.time() - began - LIMIT)
    if record.status == SIM_HANG:
        tally.left += sum(map(_alive, _noted([note])))


def _noted(notes: Any) -> Sequence[int]:
    return [int(process) for note in notes for line in note.read_text().splitlines() for process in line.split()[1:]]


def _alive(process: int) -> bool:
    """Whether a process runs; one that is killed may take a moment, and stay as an entry without a program."""
    with suppress(OSError):
        for _ in range(10):
            if Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return False
            time.sleep(0.01)
        return True
    return False
