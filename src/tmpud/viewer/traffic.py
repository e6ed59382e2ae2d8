"""What could be seen in a run, column by column, such that it packs well.

Of positions [cm] the second differences are kept, of headings [mrad], speeds [cm/s] and times [ms] the first ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from operator import sub
from typing import Any

from tmpud.events import Frame

MOST = 2**40  # a whole number beyond it is no position; JavaScript holds such numbers exactly
Row = Sequence[int]


def sound(frame: Frame) -> bool:
    """Whether a frame read from a file is what a frame should be."""
    rows = (frame.ego, *frame.others)
    named = len(frame.ids) == len(frame.others) == len(set(frame.ids)) and all(isinstance(i, str) for i in frame.ids)
    lit = all(isinstance(text, str) for text in (*frame.signals, *frame.signals.values()))
    return named and lit and 0 <= frame.time < MOST / 1000 and _whole(rows)


def columns(frames: Sequence[Frame]) -> dict[str, Any]:
    """Return times, the ego, each other vehicle in the stretches in which it was seen, and when lights switched."""
    return {
        "times": differences([round(frame.time * 1000) for frame in frames]),
        "ego": _track([frame.ego for frame in frames], speed=True),
        "cars": _cars(frames),
        "lights": _lights(frames),
    }


def differences(values: Sequence[int]) -> list[int]:
    """Return the first value and then each one's difference to the one before it."""
    return [*values[:1], *map(sub, values[1:], values)]


def _track(rows: Sequence[Row], *, speed: bool) -> list[list[int]]:
    x, y, heading, speeds = (list(column) for column in zip(*rows, strict=True)) if rows else ([], [], [], [])
    track = [differences(differences(x)), differences(differences(y)), differences(heading)]
    return [*track, differences(speeds)] if speed else track


def _cars(frames: Sequence[Frame]) -> list[list[Any]]:
    """Return [id, [number of its first frame, x, y, heading], ...] of each vehicle, by its id."""
    stretches: dict[str, list[tuple[int, list[Row]]]] = {}
    for number, frame in enumerate(frames):
        for name, row in zip(frame.ids, frame.others, strict=True):
            seen = stretches.setdefault(name, [])
            if not seen or seen[-1][0] + len(seen[-1][1]) != number:
                seen.append((number, []))
            seen[-1][1].append(row)
    return [
        [name, *([first, *_track(rows, speed=False)] for first, rows in stretches[name])] for name in sorted(stretches)
    ]


def _lights(frames: Iterable[Frame]) -> dict[str, list[list[Any]]]:
    """Return [number of a frame, letters] of each light, for each frame in which it shows something new."""
    switched: dict[str, list[list[Any]]] = {}
    for number, frame in enumerate(frames):
        for light, letters in frame.signals.items():
            shown = switched.setdefault(light, [])
            if not shown or shown[-1][1] != letters:
                shown.append([number, letters])
    return switched


def _whole(rows: Sequence[Any]) -> bool:
    """Whether each row is four whole numbers."""
    values = [*chain.from_iterable(rows)]
    return {*map(len, rows)} == {4} and {*map(type, values)} == {int} and -MOST < min(values) <= max(values) < MOST
