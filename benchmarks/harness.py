"""Several ways to the same answer take turns (A B C A B C ...); times count once the answers have been compared."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from statistics import median, quantiles
from typing import Generic, TypeVar

Case = TypeVar("Case")
Answer = float | Iterable[float]

ENOUGH = 100  # rounds from which on a p99 says more than the slowest round


class DisagreementError(Exception):
    """Two entries gave different answers: their times would not be comparable."""


class SkipError(Exception):
    """An entry cannot take part here; the message says why."""


@dataclass(frozen=True, slots=True)
class Entry(Generic[Case]):
    """One way to answer."""

    name: str
    pose: Callable[[Case], Callable[[], Answer]]  # untimed; returns the work that is timed
    tolerance: float = 0.0  # by which an answer may differ from the first entry's
    compared: bool = True  # False: a floor, which answers nothing


@dataclass(frozen=True, slots=True)
class Result:
    """What each entry took in each round."""

    title: str
    base: str  # the entry that ratios are about
    times: Mapping[str, Sequence[float]]  # entry -> a time for each round [s]
    skipped: Mapping[str, str] = field(default_factory=dict)  # entry -> why
    clock: str = "CPU time"
    facts: Mapping[str, object] = field(default_factory=dict)  # what was measured: sizes, seeds, counts
    batch: tuple[int, str] | None = None  # how many of what one time is for, where throughput is of interest

    def median(self, name: str) -> float:
        return median(self.times[name])

    def slow(self, name: str) -> float:
        """Return the p99, or the slowest of fewer than ENOUGH rounds."""
        times = self.times[name]
        return quantiles(times, n=100)[-1] if len(times) >= ENOUGH else max(times)

    def throughput(self, name: str) -> float | None:
        """Return how many of the batch's things a second gives [1/s]."""
        return self.batch[0] / self.median(name) if self.batch else None

    def ratios(self, name: str) -> list[float]:
        """Return each round's time as a multiple of the base's."""
        return [mine / base for mine, base in zip(self.times[name], self.times[self.base], strict=True)]


def race(
    entries: Sequence[Entry[Case]], cases: Sequence[Case], warmup: int = 3, turn: float = 0.0
) -> dict[str, list[float]]:
    """Return each entry's CPU time for each case [s]; raises DisagreementError.

    The first ``warmup`` cases are run once more beforehand, untimed. A turn does its work once, or over and over
    until it has lasted ``turn`` [s], when the mean counts. As in ``timeit``, garbage is collected in between.
    """
    times: dict[str, list[float]] = {entry.name: [] for entry in entries}
    early = cases[:warmup]
    for number, case in enumerate([*early, *cases], start=-len(early)):
        answers = {}
        for entry in entries:
            work = entry.pose(case)
            answers[entry.name], spent = _timed(work, turn)
            if number >= 0:
                times[entry.name].append(spent)
        _compare(entries, answers, case)
    return times


def _timed(work: Callable[[], Answer], turn: float) -> tuple[Answer, float]:
    """Return the last answer and the mean CPU time [s]."""
    gc.disable()
    try:
        began, times = time.process_time(), 0
        while True:
            answer = work()
            times, spent = times + 1, time.process_time() - began
            if spent >= turn:
                return answer, spent / times
    finally:
        gc.enable()


def field_of(makers: Mapping[str, Callable[[], Entry[Case]]]) -> tuple[list[Entry[Case]], dict[str, str]]:
    """Return the entries that can take part, and why the others cannot."""
    entries, skipped = [], {}
    for name, make in makers.items():
        try:
            entries.append(make())
        except SkipError as reason:
            skipped[name] = str(reason)
    return entries, skipped


def need(module: str) -> None:
    """Raise SkipError where an optional package is missing."""
    if find_spec(module) is None:
        raise SkipError(f"{module} is not installed; the extra 'bench' has it")


def _compare(entries: Sequence[Entry[Case]], answers: Mapping[str, Answer], case: Case) -> None:
    compared = [entry for entry in entries if entry.compared]
    if not compared:
        return
    first = _row(answers[compared[0].name])
    for entry in compared[1:]:
        row = _row(answers[entry.name])
        if len(row) != len(first) or not all(abs(a - b) <= entry.tolerance for a, b in zip(row, first, strict=True)):
            raise DisagreementError(
                f"{entry.name} answers {_shown(row)}, {compared[0].name} {_shown(first)}, to {_shown(case)}"
            )


def _row(answer: Answer) -> list[float]:
    return list(answer) if isinstance(answer, Iterable) else [answer]


def _shown(value: object) -> str:
    text = str(value)
    return text if len(text) < 200 else f"{text[:200]}..."


def progress(text: str) -> None:
    """Say on stderr what is going on; stdout has results alone."""
    print(text, file=sys.stderr, flush=True)
