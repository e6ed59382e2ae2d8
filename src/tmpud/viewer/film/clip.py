"""Which seconds of a run are shown, and why these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tmpud.errors import RequestError, RunFileError
from tmpud.events import Event, Judged, Refused
from tmpud.viewer.intact import Intact

LENGTH = 20.0  # [s] of a run that is longer, where its user does not say
BEFORE = 5.0  # [s] of it before the moment it is about
UNSAFE = ("collision", "forced_stop")


@dataclass(frozen=True, slots=True)
class Clip:
    """A part of a drive in seconds since it began, as on the replay's clock."""

    begin: float
    end: float
    why: str


def choose(run: Intact, begin: float | None, end: float | None) -> Clip:
    """Return what was asked for, within the drive; else what happens around its first moment of interest.

    Raises RunFileError where no frames were recorded and RequestError for a part that is none.
    """
    if len(run.frames) < 2:
        raise RunFileError("no frames were recorded, so there is nothing to animate; drive it without --no-frames")
    start = run.frames[0].time
    length = run.frames[-1].time - start
    if begin is None and end is None:
        return _around(*_moment(run.events, start), length)
    first, last = begin or 0.0, length if end is None else min(end, length)
    if not 0 <= first < last:
        raise RequestError(f"nothing from {first:g} s to {last:g} s: the drive took {length:.1f} s")
    return Clip(first, last, "as asked")


def _moment(events: Sequence[Event], start: float) -> tuple[float, str]:
    """Return the first refused action or unsafe moment, in seconds since the start."""
    for event in events:
        if isinstance(event, Refused):
            return event.time - start, f"around the first refused action, {event.step.action}"
        if isinstance(event, Judged) and event.kind in UNSAFE:
            return event.time - start, f"around the first {event.kind.replace('_', ' ')}"
    return 0.0, "the beginning"


def _around(moment: float, why: str, length: float) -> Clip:
    if length <= LENGTH:
        return Clip(0.0, length, "the whole drive")
    begin = min(max(moment - BEFORE, 0.0), length - LENGTH)
    return Clip(begin, begin + LENGTH, why)
