"""The predictors of an unsafe merge side by side: from recorded rows to the quality of each, as data and as a table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmpud.experiments.calibration.measures import (
    Bin,
    Refusal,
    Truth,
    area,
    brier,
    interval,
    recalibrated,
    refusals,
    reliability,
)
from tmpud.experiments.calibration.scores import BASELINES
from tmpud.experiments.reports.table import NOTHING, Table
from tmpud.experiments.reports.table import interval as interval_text
from tmpud.experiments.running.tasks import DONE, Record
from tmpud.experiments.statistics.intervals import Estimate
from tmpud.scene import FloatArray

BETAS = (0.1, 0.3, 0.5)  # the paper's thresholds
SEED = 1  # of the resampling


@dataclass(frozen=True, slots=True, eq=False)
class Merges:
    """n merges of one source with all their scores."""

    source: str  # "local", or the town
    scores: Mapping[str, FloatArray]  # (n,) each, higher is safer; inf where nothing is in the way
    unsafe: Truth  # (n,)
    groups: NDArray[np.intp]  # (n,) the drive each belongs to; local merges are each for itself


@dataclass(frozen=True, slots=True)
class Quality:
    """How well one score foretells an unsafe merge. Intervals are at 95 %, by a bootstrap over drives."""

    score: str
    area: Estimate  # under the ROC curve
    lead: Estimate | None  # its area less the first score's, on the same merges; None for the first itself
    brier: float | None  # of 1 - score; None where the score is no probability
    recalibrated: float  # Brier score after isotonic recalibration, cross-validated over drives
    refusals: tuple[Refusal, ...]  # at BETAS; none where the score is no probability
    reliability: tuple[Bin, ...]  # of 1 - score; none where the score is no probability


Measured = tuple[Merges, tuple[Quality, ...]]  # one source


def measured(records: Iterable[Record]) -> tuple[Measured, ...]:
    """Return the quality of every score on the merges of each source."""
    return tuple((merges, qualities(merges)) for merges in gather(records))


def gather(records: Iterable[Record]) -> tuple[Merges, ...]:
    """Return the merges of all drives that gave a result, by source: the first part of the record's key."""
    rows: dict[str, list[tuple[str, Mapping[str, Any]]]] = {}
    for record in sorted(records, key=lambda record: record.key):
        if record.status == DONE:
            source = record.key.partition("/")[0]
            rows.setdefault(source, []).extend((record.key, row) for row in record.result["merges"])
    return tuple(_merges(source, found) for source, found in sorted(rows.items()) if found)


def _merges(source: str, rows: list[tuple[str, Mapping[str, Any]]]) -> Merges:
    keys = [f"{key}/{i}" if source == "local" else key for i, (key, _) in enumerate(rows)]
    scores = {
        name: np.array([math.inf if row["scores"][name] is None else row["scores"][name] for _, row in rows])
        for name in rows[0][1]["scores"]
    }
    unsafe = np.array([row["unsafe"] for _, row in rows], dtype=np.bool_)
    return Merges(source, scores, unsafe, np.unique(keys, return_inverse=True)[1])


def qualities(merges: Merges) -> tuple[Quality, ...]:
    """Return the quality of each score, in the order in which the rows have them."""
    first = next(iter(merges.scores))
    return tuple(_quality(merges, name, first) for name in merges.scores)


def base_rate(merges: Merges) -> float:
    """Return the Brier score of giving every merge the share of unsafe ones; a score that tells anything is below."""
    share = float(merges.unsafe.mean())
    return share * (1 - share)


def _quality(merges: Merges, name: str, first: str) -> Quality:
    safety, unsafe, groups = merges.scores[name], merges.unsafe, merges.groups
    rng = np.random.default_rng(SEED)
    is_probability = name not in BASELINES
    risk = 1 - safety
    return Quality(
        score=name,
        area=Estimate(area(safety, unsafe), *interval(area, safety, unsafe, groups, rng), len(safety)),
        lead=None if name == first else _lead(merges, name, first),
        brier=brier(risk, unsafe) if is_probability else None,
        recalibrated=brier(recalibrated(safety, unsafe, groups, rng), unsafe),
        refusals=refusals(safety, unsafe, BETAS) if is_probability else (),
        reliability=reliability(risk, unsafe) if is_probability else (),
    )


def _lead(merges: Merges, name: str, first: str) -> Estimate:
    both = np.stack([merges.scores[name], merges.scores[first]], axis=1)

    def difference(scores: FloatArray, unsafe: Truth) -> float:
        return area(scores[:, 0], unsafe) - area(scores[:, 1], unsafe)

    ends = interval(difference, both, merges.unsafe, merges.groups, np.random.default_rng(SEED))
    return Estimate(difference(both, merges.unsafe), *ends, len(both))


def to_json(found: Iterable[Measured]) -> list[dict[str, Any]]:
    """Return what was measured with None for what is not finite."""
    return [
        {
            "source": merges.source,
            "n": len(merges.unsafe),
            "unsafe": int(merges.unsafe.sum()),
            "base_rate_brier": base_rate(merges),
            "scores": [_quality_json(quality) for quality in each],
        }
        for merges, each in found
    ]


def _quality_json(quality: Quality) -> dict[str, Any]:
    return {
        "score": quality.score,
        "area": quality.area.to_json(),
        "lead": quality.lead and quality.lead.to_json(),
        "brier": quality.brier,
        "recalibrated_brier": quality.recalibrated,
        "refusals": [
            {**each._asdict(), "unsafe": None if math.isnan(each.unsafe) else each.unsafe} for each in quality.refusals
        ],
        "reliability": [each._asdict() for each in quality.reliability],
    }


def quality_table(merges: Merges, found: Iterable[Quality]) -> Table:
    """Return the predictors of one source side by side."""
    at = (f"refused / unsafe accepted at {beta:g}" for beta in BETAS)
    columns = ("score", "area under ROC", "less the first's", "Brier", "recalibrated", *at)
    rows = tuple(
        (
            quality.score,
            interval_text(quality.area, 3),
            interval_text(quality.lead, 3) if quality.lead else NOTHING,
            NOTHING if quality.brier is None else f"{quality.brier:.3f}",
            f"{quality.recalibrated:.3f}",
            *(_refusal(refusal) for refusal in quality.refusals or (None,) * len(BETAS)),
        )
        for quality in found
    )
    n, unsafe = len(merges.unsafe), int(merges.unsafe.sum())
    drives = len(np.unique(merges.groups))
    counts = f"{n} merges ({drives} independent), {unsafe} unsafe ({unsafe / n:.3f})"
    notes = (
        f"{counts}; the Brier score of that share alone is {base_rate(merges):.3f}.",
        "Brier is that of 1 - Safe; recalibrated is that of an isotonic fit to other drives (cross-validated).",
    )
    return Table(f"Predicting an unsafe merge: {merges.source}", columns, rows, notes)


def _refusal(refusal: Refusal | None) -> str:
    if refusal is None:
        return NOTHING
    unsafe = NOTHING if math.isnan(refusal.unsafe) else f"{refusal.unsafe:.3f}"
    return f"{refusal.refused:.2f} / {unsafe}"
