"""Rows as arrays: what each algorithm did in the same trials of one condition."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tmpud.errors import RunFileError
from tmpud.experiments.running.tasks import TOOL_FAULTS
from tmpud.experiments.statistics.intervals import BoolArray
from tmpud.experiments.statistics.rows import TrialRow
from tmpud.scene import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Paired:
    """One condition's N trials (rows) by its K algorithms (columns)."""

    condition: str
    algorithms: tuple[str, ...]  # (K,)
    batches: NDArray[np.int64]  # (N,)
    counted: BoolArray  # (N, K) was run, and did not end in a tool fault
    arrived: BoolArray  # (N, K)
    unsafe: BoolArray  # (N, K) False where not counted
    distance: FloatArray  # (N, K) [m] driven, 0 where not counted

    @property
    def compared(self) -> BoolArray:
        """Tell in which trials (N,) all algorithms arrived: distances are compared in these."""
        return np.asarray(self.arrived.all(axis=1))

    @property
    def clean(self) -> BoolArray:
        """Tell in which trials (N,) all algorithms counted: unsafe behaviour is compared in these."""
        return np.asarray(self.counted.all(axis=1))

    def column(self, algorithm: str) -> int:
        return self.algorithms.index(algorithm)


def pair(
    rows: Iterable[TrialRow], conditions: Sequence[str] = (), algorithms: Sequence[str] = ()
) -> tuple[Paired, ...]:
    """Return the conditions' trials, in the order of the names given, then of the alphabet.

    Rows of the same condition, batch and trial belong together. RunFileError where one is there twice.
    """
    by_condition: defaultdict[str, list[TrialRow]] = defaultdict(list)
    for row in rows:
        by_condition[row.condition].append(row)
    return tuple(_paired(name, by_condition[name], algorithms) for name in _ordered(by_condition, conditions))


def _paired(condition: str, rows: Sequence[TrialRow], order: Sequence[str]) -> Paired:
    algorithms = _ordered({row.algorithm for row in rows}, order)
    trials = sorted({(row.batch, row.trial) for row in rows})
    line = {trial: number for number, trial in enumerate(trials)}
    column = {algorithm: number for number, algorithm in enumerate(algorithms)}
    present, counted, arrived, unsafe = np.zeros((4, len(trials), len(algorithms)), dtype=np.bool_)
    distance = np.zeros(present.shape)
    for row in rows:
        at = line[row.batch, row.trial], column[row.algorithm]
        if present[at]:
            raise RunFileError(f"{condition}, {row.algorithm}, batch {row.batch}, trial {row.trial}: there twice")
        present[at] = True
        if row.status not in TOOL_FAULTS:
            counted[at], arrived[at], unsafe[at], distance[at] = True, row.arrived, row.unsafe, row.distance
    return Paired(
        condition=condition,
        algorithms=algorithms,
        batches=np.array([batch for batch, _ in trials], dtype=np.int64),
        counted=counted,
        arrived=arrived,
        unsafe=unsafe,
        distance=distance,
    )


def _ordered(names: Iterable[str], order: Sequence[str]) -> tuple[str, ...]:
    found = set(names)
    return (*(name for name in order if name in found), *sorted(found.difference(order)))
