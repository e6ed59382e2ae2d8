"""Sections about what must not cost a result: kills, interrupts, full disks, damage, crashes, a second supervisor."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from tests.experiments.running.damages import damage
from tests.experiments.running.faults import LIMIT, misbehave
from tests.experiments.running.kills import Found, Plan, placed_plans, random_plans, strike, unbroken
from tests.experiments.running.strikes import fill_disk, full_plans, interrupt, interrupt_plans, meet, meeting_plans
from tmpud.experiments.running.progress import Progress
from tools.verification.figures import Figure
from tools.verification.options import Options
from tools.verification.trials import each

SEED = 1
STOPPING = 3.0  # [s] at most from an interrupt to the end of all processes, and from a limit to a record
COUNTED = "lost", "doubled", "changed", "missing", "orphans"


def kills(options: Options) -> list[Figure]:
    """Kill campaigns at random and at placed moments: worker, supervisor or both."""
    return [
        _struck("campaigns killed at random moments, resumed", strike, random_plans(options.kills, SEED)),
        _struck("campaigns killed before, within, after writes, resumed", strike, placed_plans(options.kills, SEED)),
    ]


def interrupts(options: Options) -> list[Figure]:
    """Interrupt campaigns, also within tasks that take an hour."""
    return [_struck("campaigns interrupted, resumed", interrupt, interrupt_plans(options.interrupts, SEED))]


def disks(options: Options) -> list[Figure]:
    """Run out of disk at any size of the results."""
    return [_struck("campaigns out of disk, resumed", fill_disk, full_plans(options.disks, SEED))]


def supervisors(options: Options) -> list[Figure]:
    """Refuse a second supervisor on a folder; take over from one that was killed."""
    return [_struck("second supervisors refused, dead ones' folders recovered", meet, meeting_plans(options.meetings))]


def damages(options: Options) -> list[Figure]:
    """Damage results files and read them."""
    with tempfile.TemporaryDirectory() as folder:
        tally = damage(options.damages, SEED, Path(folder))
    return [
        Figure(
            what="damaged results files read",
            n=tally.cases,
            result=f"{tally.wrong} wrong values; {tally.unnamed} of {tally.damaged_lines:,} damaged lines not named; "
            f"{tally.dropped} whole records dropped",
            target="0 wrong, 0 not named, 0 dropped",
            holds=not (tally.wrong or tally.unnamed or tally.misnamed or tally.dropped),
            seed=SEED,
            details={"notes": tally.notes[:20], "whole_lines_named": tally.misnamed},
        )
    ]


def hangs(options: Options) -> list[Figure]:
    """Crash, hang and talk nonsense among tasks that do not."""
    tally = misbehave(options.hangs, SEED)
    return [
        Figure(
            what="tasks that crash, hang or answer nonsense, each among as many that do not",
            n=tally.bad,
            result=f"{tally.wrong_status} with a wrong status; {tally.harmed} of {tally.good} others harmed; "
            f"{tally.left} processes left; the last record {tally.latest:.2f} s after the limit of {LIMIT:g} s",
            target=f"0 wrong, 0 harmed, 0 left, at most {STOPPING:g} s",
            holds=tally.bad == tally.good == options.hangs
            and not (tally.wrong_status or tally.harmed or tally.left)
            and tally.latest <= STOPPING,
            seed=SEED,
            details={"notes": tally.notes[:20]},
        )
    ]


def _struck(what: str, do: Callable[[Plan], Found], plans: Sequence[Plan]) -> Figure:
    """Strike campaigns as planned, and sum up what came of them."""
    for isolated in (False, True):
        unbroken(isolated)  # timed while nothing else runs
    progress = Progress(what.partition(",")[0], len(plans))
    found = []
    for _, one in each(do, plans):
        found.append(one)
        progress.step()
    counts = {name: sum(getattr(one, name) for one in found) for name in COUNTED}
    unsound, spared = sum(not one.sound for one in found), sum(not one.struck for one in found)
    slowest = max((one.seconds for one in found), default=0.0)
    return Figure(
        what=what,
        n=len(found),
        result=f"{', '.join(f'{count} {name}' for name, count in counts.items())}; {unsound} unlike unbroken ones"
        + (f"; all ended within {slowest:.2f} s" if slowest else "")
        + (f"; {spared} not struck" if spared else ""),
        target="0 of each, the same hash" + (f", within {STOPPING:g} s" if slowest else ""),
        holds=not (unsound or spared) and slowest <= STOPPING,
        seed=SEED,
        details={"notes": [note for one in found if not one.sound for note in one.notes][:20]},
    )
