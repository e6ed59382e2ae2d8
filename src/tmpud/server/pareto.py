"""Where the points of a Pareto picture lie on a page: mean distance to the right, unsafe trials upwards."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tmpud.experiments.reports.charts import Panel, Span
    from tmpud.experiments.reports.charts import Point as Result
    from tmpud.experiments.statistics.paper_numbers import PaperCell, Reference

WIDTH, HEIGHT = 440, 320  # of a panel [px]
LEFT, RIGHT, TOP, BOTTOM = 52, 16, 14, 42  # margins
LINE = 14  # between two labels, at least [px]
SHAPES = {  # of matplotlib's markers, around the origin
    "*": "M0-8 1.9-2.6 7.6-2.5 3-1 4.7 6.5 0 3.1-4.7 6.5-3-1-7.6-2.5-1.9-2.6Z",
    "s": "M-5-5H5V5H-5Z", "D": "M0-6.5 6.5 0 0 6.5-6.5 0Z", "^": "M0-6 6 5H-6Z", "v": "M0 6 6-5H-6Z",
    "o": "M-5.5 0A5.5 5.5 0 1 0 5.5 0 5.5 5.5 0 1 0-5.5 0Z", "P": "M-2-6H2V-2H6V2H2V6H-2V2H-6V-2H-2Z",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Point:
    """What a point stands for: one algorithm in one condition."""

    condition: str
    algorithm: str
    trials: int
    unsafe: int
    faults: int
    arrived: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Dot:
    """A point on the page [px], y downwards; a bar is None where its ends are not known."""

    number: int | None  # of its point; None where it is the paper's
    x: float
    y: float
    across: tuple[float, float] | None
    upright: tuple[float, float] | None
    colour: str
    shape: str  # path
    label: str
    label_y: float
    words: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawn:
    """A panel."""

    title: str
    across: tuple[tuple[float, str], ...]  # ticks: where, and what stands there
    upright: tuple[tuple[float, str], ...]
    dots: tuple[Dot, ...]
    absent: tuple[tuple[int, str], ...]  # points that have no place, since no trial could be compared

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Drawn:
        return cls(**{**row, "dots": tuple(Dot(**dot) for dot in row["dots"])})


def draw(panels: Sequence[Panel], reference: Reference) -> list[Drawn]:
    """Return the panels with their points numbered through, in their order, the paper's points behind them."""
    from tmpud.experiments.reports.charts import PAPER, label, styles

    looks = styles([point.algorithm for panel in panels for point in panel.points])
    found, number = [], 0
    for panel in panels:
        paper = reference.get(panel.title, {})
        scale = _Scale(panel.points, paper.values())
        dots = [
            _dot(scale, None, _exactly(cell), PAPER, looks[name].marker, ("", f"the paper's {label(name)}"))
            for name, cell in paper.items()
        ]
        absent = []
        for point in panel.points:
            if _seen(point):
                look, spans = looks[point.algorithm], (point.distance, point.unsafe)
                words = (label(point.algorithm), point.words)
                dots.append(_dot(scale, number, spans, look.colour, look.marker, words))
            else:
                absent.append((number, label(point.algorithm)))
            number += 1
        ticks = scale.ticks()
        spread = tuple(_spread(dots))
        found.append(Drawn(title=panel.title, across=ticks[0], upright=ticks[1], dots=spread, absent=tuple(absent)))
    return found


def _seen(point: Result) -> bool:
    return math.isfinite(point.distance[1]) and math.isfinite(point.unsafe[1])


def _exactly(cell: PaperCell) -> tuple[Span, Span]:
    return (cell.distance,) * 3, (cell.per_1000,) * 3


class _Scale:
    """From metres and shares to the page."""

    def __init__(self, points: Iterable[Result], paper: Iterable[PaperCell]) -> None:
        spans = [(point.distance, point.unsafe) for point in points if _seen(point)] + [_exactly(c) for c in paper]
        self.x = _range([value for span, _ in spans for value in span])
        low, high = _range([0.0, *(value for _, span in spans for value in span)])
        self.y = max(low, -0.04 * high), high  # there are no shares below 0

    def at(self, x: float, y: float) -> tuple[float, float]:
        share_x, share_y = ((v - low) / (high - low) for v, (low, high) in ((x, self.x), (y, self.y)))
        return (
            round(LEFT + share_x * (WIDTH - LEFT - RIGHT), 1),
            round(HEIGHT - BOTTOM - share_y * (HEIGHT - TOP - BOTTOM), 1),
        )

    def ticks(self) -> tuple[tuple[tuple[float, str], ...], tuple[tuple[float, str], ...]]:
        across = tuple((self.at(value, 0)[0], f"{value:g}") for value in _round_numbers(*self.x))
        return across, tuple((self.at(0, value)[1], f"{value:g}") for value in _round_numbers(*self.y))


def _range(values: Iterable[float]) -> tuple[float, float]:
    """Return a little more than the values take up."""
    known = [value for value in values if math.isfinite(value)] or [0.0]
    low, high = min(known), max(known)
    room = 0.08 * (high - low) or 1.0
    return low - room, high + room


def _round_numbers(low: float, high: float) -> Iterable[float]:
    from matplotlib.ticker import MaxNLocator

    return (float(v) for v in MaxNLocator(6, steps=(1, 2, 5, 10)).tick_values(low, high) if low <= v <= high)


def _dot(
    scale: _Scale, number: int | None, spans: tuple[Span, Span], colour: str, marker: str, words: tuple[str, str]
) -> Dot:
    (left, x, right), (low, y, high) = spans
    px, py = scale.at(x, y)
    across, upright = (scale.at(left, y)[0], scale.at(right, y)[0]), (scale.at(x, low)[1], scale.at(x, high)[1])
    return Dot(
        number=number,
        x=px,
        y=py,
        across=across if all(map(math.isfinite, across)) and left < right else None,
        upright=upright if all(map(math.isfinite, upright)) and low < high else None,
        colour=colour,
        shape=SHAPES[marker],
        label=words[0],
        label_y=py - 6,
        words=words[1],
    )


def _spread(dots: Iterable[Dot]) -> Iterable[Dot]:
    """Yield the dots with labels that do not hide each other."""
    from dataclasses import replace

    taken: list[tuple[float, float]] = []
    for dot in dots:
        y = dot.label_y
        while dot.label and any(abs(x - dot.x) < 80 and abs(other - y) < LINE for x, other in taken):
            y -= LINE
        if dot.label:
            taken.append((dot.x, y))
        yield replace(dot, label_y=max(y, TOP))
