"""Trials with planted effects: what each algorithm does in them is written down, not driven."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tmpud.experiments.statistics.rows import TrialRow

# algorithm -> (metres more than the shortest, on average; unsafe trials per trial), in the paper's order of merit
AS_PAPER = {
    "no-com": (0.0, 0.25),
    "threshold(0.1)": (50.0, 0.13),
    "threshold(0.3)": (90.0, 0.06),
    "threshold(0.5)": (120.0, 0.005),
    "tmpud": (95.0, 0.005),
}


def planted(
    n: int,
    seed: int,
    effects: Mapping[str, tuple[float, float]] = AS_PAPER,
    condition: str = "normal",
    batches: int = 1,
) -> list[TrialRow]:
    """Return n paired trials: a trial's luck is the same for all algorithms, to which each adds its own."""
    rng = np.random.default_rng(seed)
    rows = []
    for trial in range(n):
        shared, luck = rng.normal(430, 5), rng.uniform()
        for algorithm, (longer, unsafe) in effects.items():
            hit = bool(luck < unsafe)
            rows.append(
                TrialRow(
                    condition=condition,
                    algorithm=algorithm,
                    trial=trial,
                    batch=trial * batches // n,
                    status="COLLISION" if hit and rng.uniform() < 0.5 else "SUCCESS",
                    distance=shared + rng.exponential(longer) if longer else shared,
                    unsafe=hit,
                    details={"collisions": {"merge": 1} if hit else {}, "forced_stops": 0},
                )
            )
    return rows


def row(algorithm: str, trial: int, **others: object) -> TrialRow:
    """Return a row of one trial, arrived safely unless told otherwise."""
    values = {"condition": "normal", "status": "SUCCESS", "distance": 400.0, "unsafe": False, **others}
    return TrialRow(algorithm=algorithm, trial=trial, **values)  # type: ignore[arg-type]
