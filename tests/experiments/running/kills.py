"""Campaigns killed at random and at placed moments, resumed, and compared with one that was not."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

from tests.experiments.running.victim import COUNT, ONCE, PLAN, POINTS
from tmpud.experiments.running.store import RESULTS, read_results
from tmpud.experiments.running.tasks import Record, results_hash

PATIENCE = 60.0  # [s] for a campaign
VANISHING = 3.0  # [s] for all processes of a campaign that was killed
ROOT = Path(__file__).resolve().parents[3]

Plan = Mapping[str, Any]


@dataclass(slots=True)
class Found:
    """What a campaign that was struck came to; all counts but ``struck`` are to be 0."""

    struck: bool = False
    lost: int = 0  # results that were given back before the blow and are not in the folder after it
    doubled: int = 0
    changed: int = 0  # results other than those of the unbroken campaign
    missing: int = 0  # tasks without a result when all is done
    orphans: int = 0
    seconds: float = 0.0  # from an interrupt to the end of all processes
    notes: list[str] = field(default_factory=list)

    @property
    def sound(self) -> bool:
        return not (self.lost or self.doubled or self.changed or self.missing or self.orphans or self.notes)


class Campaign:
    """A victim under way, and what it has given back."""

    def __init__(self, folder: Path, plan: Plan) -> None:
        setting = json.dumps({**plan, "id": str(folder)})
        self.mark = f"{PLAN}={setting}"
        self._out, self._err = folder.with_suffix(".out"), folder.with_suffix(".err")
        with self._out.open("wb") as out, self._err.open("wb") as err:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "tests.experiments.running.victim", str(folder)],
                cwd=ROOT, stdout=out, stderr=err, start_new_session=True, env={**os.environ, PLAN: setting},
            )  # fmt: skip

    @property
    def given(self) -> list[str]:
        return [line for line in self._out.read_text().splitlines(keepends=True) if line.endswith("\n")]

    def said(self) -> str:
        return self._err.read_text()

    def wait(self) -> int:
        """Return the exit code; one that takes too long is killed."""
        try:
            return self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()

    def others(self) -> list[int]:
        """Return all living processes of the campaign but the supervisor."""
        return [process for process in marked(self.mark) if process != self.process.pid]

    def left_over(self) -> int:
        """Return how many processes are still there when they had time to vanish; they are ended."""
        until = time.monotonic() + VANISHING
        while (left := marked(self.mark)) and time.monotonic() < until:
            time.sleep(0.02)
        for process in left:
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
        return len(left)


def marked(mark: str) -> list[int]:
    """Return the living processes that have a setting in their environment."""
    found = []
    for folder in Path("/proc").iterdir():
        with suppress(OSError):
            if folder.name.isdecimal() and mark.encode() in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
    return found


@cache
def unbroken(isolated: bool) -> tuple[dict[str, Record], str, float]:
    """Return the results of a campaign that nothing struck, their hash, and how long [s] it took."""
    with tempfile.TemporaryDirectory() as folder:
        began = time.monotonic()
        assert Campaign(Path(folder) / "unbroken", {"isolated": isolated}).wait() == 0
        took = time.monotonic() - began
        records = read_results(Path(folder) / "unbroken").records
    assert len(records) == COUNT
    return {record.key: record for record in records}, results_hash(records), took


def random_plans(number: int, seed: int) -> list[Plan]:
    """Return whom to kill when: the worker, the supervisor or both, at any share of an unbroken campaign's time.

    A plan has several moments, to be tried until one finds somebody to kill.
    """
    rng = random.Random(seed)
    return [
        {
            "isolated": n % 2 == 1,
            "whom": ("worker", "supervisor", "both")[n // 2 % 3],
            "at": [rng.uniform(0.05, 0.95) for _ in range(6)],
            "which": rng.random(),  # of the processes of workers
        }
        for n in range(number)
    ]


def placed_plans(number: int, seed: int) -> list[Plan]:
    """Return moments before, within and after writes of supervisor and worker at which they are killed."""
    at_supervisor: list[Plan] = [
        {"isolated": isolated, "point": {"point": point, "nth": nth, "both": both}}
        for point, nth, both, isolated in product(POINTS, (1, 2, 3), (False, True), (False, True))
        if (nth == 1 or point not in ONCE)
    ]
    in_work: list[Plan] = [
        {"isolated": isolated, "work": {"moment": moment, "key": key, "whom": whom}}
        for moment, key, whom, isolated in product(
            ("prepare", "run", "half an answer", "after"), ("0000", "0008", "0016"),
            ("task", "worker", "supervisor", "both", "all"), (False, True),
        )
        if not (isolated and (moment, whom) == ("after", "task"))
    ]  # fmt: skip
    rng = random.Random(seed)
    return [
        plan
        for plans, share in ((at_supervisor, number - number // 2), (in_work, number // 2))
        for plan in rng.sample(plans, min(share, len(plans)))
    ]


def strike(plan: Plan) -> Found:
    """Kill a campaign as planned, resume it until it is done, and compare."""
    with tempfile.TemporaryDirectory() as parent:
        folder, found = Path(parent) / "struck", Found()
        expected, whole_hash, took = unbroken(plan["isolated"])
        mark = Path(parent) / "mark"
        if "work" in plan:
            plan = {**plan, "work": {**plan["work"], "mark": str(mark)}}
        campaign = Campaign(folder, plan)
        if "at" in plan:
            time.sleep(took * plan["at"][0])
            found.struck = kill(campaign, plan["whom"], plan["which"])
        code = campaign.wait()
        found.struck |= code == -signal.SIGKILL or mark.exists()
        found.orphans += campaign.left_over()
        compare_midway(found, folder, campaign.given, expected)
        if code:
            resumed = Campaign(folder, {"isolated": plan["isolated"]})
            if resumed.wait():
                found.notes.append(f"not resumed: {resumed.said()[-300:]}")
            found.orphans += resumed.left_over()
        compare(found, folder, expected, whole_hash)
    if not found.struck and len(plan.get("at", ())) > 1:
        return strike({**plan, "at": plan["at"][1:]})
    if not found.sound:
        found.notes.append(f"plan: {json.dumps(plan)}")
    return found


def kill(campaign: Campaign, whom: str, which: float) -> bool:
    """Kill the supervisor, some process of a worker, or first that and then the supervisor; whether one was there."""
    workers = campaign.others() if whom != "supervisor" else []
    victims = workers[int(which * len(workers)) :][:1] + ([campaign.process.pid] if whom != "worker" else [])
    alive = bool(victims) and campaign.process.poll() is None
    for victim in victims:
        with suppress(ProcessLookupError):
            os.kill(victim, signal.SIGKILL)
    return alive


def compare_midway(found: Found, folder: Path, given: Sequence[str], expected: Mapping[str, Record]) -> None:
    """Note results that were given back and are not there after the blow, or are others."""
    if not given:
        return
    kept = {record.key: record for record in read_results(folder).records}
    found.lost += sum(key.strip() not in kept for key in given)
    found.changed += sum(record != expected.get(key) for key, record in kept.items())


def compare(found: Found, folder: Path, expected: Mapping[str, Record], whole_hash: str) -> None:
    """Note what is wrong with a campaign that is done."""
    results = read_results(folder)
    lines = (folder / RESULTS).read_bytes().splitlines()
    found.doubled += len(lines) - len(set(lines))
    found.missing += len(expected.keys() - {record.key for record in results.records})
    found.changed += sum(record != expected.get(record.key) for record in results.records)
    if results_hash(results.records) != whole_hash:
        found.notes.append("another hash than the unbroken campaign's")
    found.notes.extend(results.damages)
