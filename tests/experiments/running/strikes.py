"""Campaigns that are interrupted, run out of disk, or meet another on their folder."""

from __future__ import annotations

import os
import random
import signal
import tempfile
import time
from pathlib import Path

from tests.experiments.running.kills import PATIENCE, Campaign, Found, Plan, compare, compare_midway, unbroken
from tmpud.experiments.running.store import LOCK, RESULTS

REFUSED = 2  # exit code
INTERRUPTED = 130  # exit code
MESSAGE = 256  # [bytes] that what is said of a full disk needs, in a file as limited as the others


def interrupt_plans(number: int, seed: int) -> list[Plan]:
    """Return moments of SIGINT and SIGTERM, to the supervisor alone or, as a terminal does, to its whole group.

    In half of the campaigns, every third task is one that takes an hour.
    """
    rng = random.Random(seed)
    return [
        {
            "isolated": n % 2 == 1,
            "stuck": n // 2 % 2 == 1,
            "signal": signal.SIGTERM if n % 5 == 4 else signal.SIGINT,
            "group": rng.random() < 0.5,
            "at": rng.uniform(0.0, 0.6),
        }
        for n in range(number)
    ]


def interrupt(plan: Plan) -> Found:
    """Interrupt a campaign as planned; then resume it until it is done, and compare."""
    expected, whole_hash, took = unbroken(plan["isolated"])
    with tempfile.TemporaryDirectory() as parent:
        folder, found = Path(parent) / "struck", Found()
        campaign = Campaign(folder, plan)
        _wait_for(folder / LOCK, campaign)  # before, an interrupt may still be one that a shell had ignored
        time.sleep(took * plan["at"])
        found.struck = campaign.process.poll() is None
        if found.struck:
            (os.killpg if plan["group"] else os.kill)(campaign.process.pid, plan["signal"])
        began = time.monotonic()
        code = campaign.wait()
        found.orphans = campaign.left_over()
        found.seconds = time.monotonic() - began
        outside = -plan["signal"]  # it came while Python itself started or ended: nothing of ours ran
        if code not in ((INTERRUPTED, outside) if found.struck else (0,)):
            found.notes.append(f"exit code {code}: {campaign.said()[-300:]}")
        compare_midway(found, folder, campaign.given, expected)
        _resume(folder, plan, found)
        compare(found, folder, expected, whole_hash)
    return found


def fill_disk(plan: Plan) -> Found:
    """Let a campaign's files grow to ``plan["full"]`` bytes only; then resume it with room enough, and compare."""
    expected, whole_hash, _ = unbroken(plan["isolated"])
    with tempfile.TemporaryDirectory() as parent:
        folder, found = Path(parent) / "struck", Found()
        campaign = Campaign(folder, plan)
        code, said = campaign.wait(), campaign.said()
        found.orphans = campaign.left_over()
        found.struck = code == REFUSED
        if found.struck and (said.count("\n") != 1 or "too large" not in said):
            found.notes.append(f"said: {said[-300:]}")
        compare_midway(found, folder, campaign.given, expected)
        _resume(folder, plan, found)
        compare(found, folder, expected, whole_hash)
    return found


def full_plans(number: int, seed: int) -> list[Plan]:
    """Return sizes at which the disk is full, up to that of the results."""
    rng = random.Random(seed)
    largest = results_size()
    return [{"isolated": False, "full": rng.randrange(MESSAGE, largest)} for _ in range(number)]


def results_size() -> int:
    """Return the size [bytes] of an unbroken campaign's results."""
    with tempfile.TemporaryDirectory() as parent:
        assert Campaign(Path(parent) / "whole", {"isolated": False}).wait() == 0
        return (Path(parent) / "whole" / RESULTS).stat().st_size


def meet(plan: Plan) -> Found:
    """Start a second supervisor on the folder of one that runs; kill the first, and let a third take over."""
    expected, whole_hash, _ = unbroken(plan["isolated"])
    with tempfile.TemporaryDirectory() as parent:
        folder, found = Path(parent) / "struck", Found()
        first = Campaign(folder, {**plan, "stuck": True})
        _wait_for(folder / LOCK, first)
        second = Campaign(folder, {**plan, "id": "second"})
        found.struck = second.wait() == REFUSED and f"in use by process {first.process.pid}" in second.said()
        if not found.struck:
            found.notes.append(f"not refused: {second.said()[-300:]}")
        first.process.kill()
        first.wait()
        compare_midway(found, folder, first.given, expected)
        _resume(folder, plan, found)
        found.orphans += first.left_over()
        compare(found, folder, expected, whole_hash)
    return found


def meeting_plans(number: int) -> list[Plan]:
    return [{"isolated": n % 2 == 1} for n in range(number)]


def _resume(folder: Path, plan: Plan, found: Found) -> None:
    resumed = Campaign(folder, {"isolated": plan["isolated"]})
    if resumed.wait():
        found.notes.append(f"not resumed: {resumed.said()[-300:]}")
    found.orphans += resumed.left_over()


def _wait_for(lock: Path, owner: Campaign) -> None:
    """Wait until the lock names its owner."""
    until = time.monotonic() + PATIENCE
    while not (lock.exists() and lock.read_text().strip() == str(owner.process.pid)):
        assert time.monotonic() < until
        time.sleep(0.02)
