"""The cells of the paper's table: how far and how safely each algorithm drove in each condition."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmpud.experiments.running.tasks import TOOL_FAULTS
from tmpud.experiments.statistics.intervals import RESAMPLES, Estimate, mean_estimates, wilson
from tmpud.experiments.statistics.pairing import Paired
from tmpud.experiments.statistics.rows import TrialRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One algorithm in one condition; tool faults are counted, and count neither as safe nor as unsafe."""

    condition: str
    algorithm: str
    trials: int  # run, tool faults included
    faults: int  # of these, tool faults
    unsafe: int  # trials with at least one unsafe behaviour
    per_1000: Estimate  # unsafe trials per 1,000, Wilson's interval
    events: Mapping[str, int]  # collisions by class and forced stops, several in one trial counted apart
    distance: Estimate  # [m] mean over the trials in which all compared algorithms arrived, BCa interval
    arrived: int  # trials in which this algorithm did
    own_distance: float  # [m] mean over these; NaN where there are none
    statuses: Mapping[str, int]

    def to_json(self) -> dict[str, Any]:
        plain = {name: getattr(self, name) for name in ("condition", "algorithm", "trials", "faults", "unsafe")}
        return {
            **plain,
            "per_1000": self.per_1000.to_json(),
            "events": dict(self.events),
            "distance": self.distance.to_json(),
            "arrived": self.arrived,
            "own_distance": self.own_distance if self.arrived else None,
            "statuses": dict(self.statuses),
        }


def cells(
    paired: Paired, rows: Iterable[TrialRow], rng: np.random.Generator, resamples: int = RESAMPLES
) -> tuple[Cell, ...]:
    """Return one condition's cells in the order of its algorithms; rows of other conditions are left out."""
    own: dict[str, list[TrialRow]] = {algorithm: [] for algorithm in paired.algorithms}
    for row in rows:
        if row.condition == paired.condition:
            own[row.algorithm].append(row)
    distances = mean_estimates(paired.distance[paired.compared], rng, resamples)
    return tuple(
        _cell(paired.condition, algorithm, own[algorithm], distance)
        for algorithm, distance in zip(paired.algorithms, distances, strict=True)
    )


def _cell(condition: str, algorithm: str, rows: Sequence[TrialRow], distance: Estimate) -> Cell:
    counted = [row for row in rows if row.status not in TOOL_FAULTS]
    unsafe = sum(row.unsafe for row in counted)
    arrived = [row.distance for row in counted if row.arrived]
    return Cell(
        condition=condition,
        algorithm=algorithm,
        trials=len(rows),
        faults=len(rows) - len(counted),
        unsafe=unsafe,
        per_1000=wilson(unsafe, len(counted)).scaled(1000),
        events=_events(counted),
        distance=distance,
        arrived=len(arrived),
        own_distance=math.fsum(arrived) / len(arrived) if arrived else math.nan,  # whatever the order of the rows
        statuses=dict(sorted(Counter(row.status for row in rows).items())),
    )


def _events(rows: Sequence[TrialRow]) -> dict[str, int]:
    """Count what the rows' details tell of: unsafe are collisions of merges and forced stops, other classes are not."""
    told = [row.details for row in rows if {"collisions", "forced_stops"} <= set(row.details)]
    collisions = Counter({"merge": 0})
    for details in told:
        collisions.update(details["collisions"])
    stops = sum(details["forced_stops"] for details in told)
    return {**{f"{name} collisions": n for name, n in collisions.items()}, "forced stops": stops} if told else {}
