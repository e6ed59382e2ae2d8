"""Wall-clock latencies, kept apart from the events so that the same seed gives the same log."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


class Latency(NamedTuple):
    kind: str  # plan, estimate or step
    milliseconds: float


@dataclass(slots=True)
class Stopwatch:
    """Measures the calls of functions that it wraps."""

    latencies: list[Latency] = field(default_factory=list)

    def timed(self, kind: str, function: Callable[P, R]) -> Callable[P, R]:
        """Return the function, its calls measured."""

        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            begin = time.perf_counter()
            try:
                return function(*args, **kwargs)
            finally:
                self.latencies.append(Latency(kind, (time.perf_counter() - begin) * 1000))

        return call

    def summary(self) -> dict[str, dict[str, float]]:
        """Return count, median and maximum [ms] for each kind."""
        kinds: dict[str, list[float]] = {}
        for latency in self.latencies:
            kinds.setdefault(latency.kind, []).append(latency.milliseconds)
        return {
            kind: {"n": len(values), "median": round(sorted(values)[len(values) // 2], 3), "max": round(max(values), 3)}
            for kind, values in sorted(kinds.items())
        }
