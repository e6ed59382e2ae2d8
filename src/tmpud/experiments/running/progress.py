"""A line on stderr that says how far something is, how fast it goes and how long it will take."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

T = TypeVar("T")
QUIET = 15.0  # [s] between lines where nobody watches


class Progress:
    """Counts what is done of a known total."""

    def __init__(self, name: str, total: int) -> None:
        self._name, self._total, self._done, self._skipped = name, total, 0, 0
        self._began = self._shown = time.monotonic()

    def over(self, items: Iterable[T], each: int = 1) -> Iterator[T]:
        """Pass items on; each that has been dealt with counts as ``each`` done."""
        for item in items:
            yield item
            self.step(each)

    def skip(self, by: int) -> None:
        """Count some as done earlier: the rate is that of the others."""
        self._done += by
        self._skipped += by

    def step(self, by: int = 1, note: str = "") -> None:
        """Count some more as done."""
        self._done += by
        now, watched = time.monotonic(), sys.stderr.isatty()
        if now - self._shown < (0.2 if watched else QUIET) and self._done < self._total:
            return
        self._shown = now
        rate = (self._done - self._skipped) / max(now - self._began, 1e-9)
        left = max(self._total - self._done, 0) / rate if rate else 0.0
        line = f"{self._name:<24}{self._done:>7,}/{self._total:,}  {_rate(rate)}  {_clock(left)} left  {note}"
        end = "\n" if not watched or self._done >= self._total else "\r"
        sys.stderr.write(line + end)
        sys.stderr.flush()


def _rate(per_second: float) -> str:
    return f"{per_second:,.1f}/s" if per_second >= 1 else f"{per_second * 60:,.1f}/min"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"
