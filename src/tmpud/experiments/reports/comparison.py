"""Two runs compared, trial by trial: other presets, other versions, other simulators."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from tmpud.errors import RequestError
from tmpud.experiments.reports.table import Table, interval
from tmpud.experiments.statistics.intervals import mean_estimates, share_differences
from tmpud.experiments.statistics.pairing import Paired, pair
from tmpud.experiments.statistics.rows import TrialRow

FIRST, SECOND = "first", "second"
RESAMPLING_SEED = 2


def compare_runs(first: Iterable[TrialRow], second: Iterable[TrialRow]) -> Table:
    """Return for each condition and algorithm of both runs the paired differences, second minus first.

    RequestError where they have no condition and algorithm in common.
    """
    runs = {FIRST: _by_cell(first), SECOND: _by_cell(second)}
    common = [cell for cell in runs[FIRST] if cell in runs[SECOND]]
    if not common:
        raise RequestError("the two runs have no condition and algorithm in common")
    rng = np.random.default_rng(RESAMPLING_SEED)
    rows = []
    for cell in common:
        together = [replace(row, algorithm=name) for name in runs for row in runs[name][cell]]
        (paired,) = pair(together, algorithms=(FIRST, SECOND))
        rows.append((*cell, *_differences(paired, rng)))
    columns = ("", "algorithm", "trials", "distance [m]", "unsafe per 1,000", "equal trials")
    return Table(
        "Second run less first", columns, tuple(rows), ("Paired by trial number; in brackets: 95 % intervals.",)
    )


def _differences(paired: Paired, rng: np.random.Generator) -> tuple[str, ...]:
    clean, arrived = paired.clean, paired.compared
    before, after = (paired.column(name) for name in (FIRST, SECOND))
    metres = mean_estimates((paired.distance[:, [after]] - paired.distance[:, [before]])[arrived], rng)[0]
    unsafe = paired.unsafe[clean]
    share = share_differences(unsafe[:, [after]], unsafe[:, [before]], rng)[0].scaled(1000)
    same = clean & (paired.unsafe[:, after] == paired.unsafe[:, before])
    same &= np.isclose(paired.distance[:, after], paired.distance[:, before], atol=1e-6)
    return str(int(clean.sum())), interval(metres), interval(share), str(int(same.sum()))


def _by_cell(rows: Iterable[TrialRow]) -> dict[tuple[str, str], list[TrialRow]]:
    found: dict[tuple[str, str], list[TrialRow]] = {}
    for row in rows:
        found.setdefault((row.condition, row.algorithm), []).append(row)
    return found
