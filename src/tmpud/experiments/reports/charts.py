"""Mean distance against unsafe trials per 1,000, a panel per condition, the paper's points in grey behind ours."""

from __future__ import annotations

import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from tmpud.experiments.reports.document import Picture
from tmpud.experiments.reports.table import anchor
from tmpud.experiments.statistics.cells import Cell
from tmpud.experiments.statistics.pairing import Paired
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, LABELS, Reference

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # told apart by the colour-blind
MARKERS = ("*", "s", "D", "^", "o", "v", "P")  # one more than colours: pairs return late
LONGEST = 40  # letters of a name in a chart
PAPER, TEXT, GRID = "#9aa0a8", "#1a1a1a", "#e3e5e8"
PLACES = ((8, 6), (8, -12), (-8, 6), (-8, -12), (8, 16), (8, -22), (-8, 16), (-8, -22))  # [pt]
LOOK: dict[Any, Any] = {
    "svg.hashsalt": "tmpud",  # equal charts are equal files
    "font.size": 9,
    "text.color": TEXT,
    "axes.labelcolor": TEXT,
    "legend.frameon": False,
    "legend.columnspacing": 1.0,
    "legend.handletextpad": 0.2,
}


@dataclass(frozen=True, slots=True)
class Style:
    """How an algorithm looks."""

    colour: str
    marker: str

    def mark(self, colour: str, *at: float) -> Line2D:
        """Return its mark in this colour, at one place or, for a legend, at none."""
        size = 11 if self.marker == "*" else 6.5
        mark = Line2D(at[:1], at[1:], color=colour, marker=self.marker, markersize=size, linestyle="none", zorder=4)
        mark.set_markeredgecolor("white")
        mark.set_markeredgewidth(0.6)
        return mark


Span = tuple[float, float, float]  # low, value, high


@dataclass(frozen=True, slots=True)
class Point:
    """One algorithm's result."""

    algorithm: str
    distance: Span  # [m]
    unsafe: Span  # trials per 1,000

    @property
    def words(self) -> str:
        metres, share = self.distance[1], self.unsafe[1]
        return f"{label(self.algorithm)}: {metres:.1f} m on average, {share:.1f} unsafe trials per 1,000"


@dataclass(frozen=True, slots=True)
class Panel:
    """One condition."""

    title: str
    points: tuple[Point, ...]


def interval_panels(cells: Iterable[Cell]) -> tuple[Panel, ...]:
    """Return a panel per condition whose bars are 95 % intervals."""
    points: dict[str, list[Point]] = {}
    for cell in cells:
        spans = [(found.low, found.value, found.high) for found in (cell.distance, cell.per_1000)]
        points.setdefault(cell.condition, []).append(Point(cell.algorithm, *spans))
    return tuple(Panel(condition, tuple(those)) for condition, those in points.items())


def batch_panels(pairs: Iterable[Paired]) -> tuple[Panel, ...]:
    """Return a panel per condition with the mean over its batches, whose bars are one standard deviation of these."""
    return tuple(Panel(paired.condition, tuple(_batch_points(paired))) for paired in pairs)


def draw(panels: Sequence[Panel], reference: Reference, name: str, caption: str) -> Picture:
    """Draw panels side by side, as the paper does; in the SVG, a point leads to its row in the table of cells."""
    algorithms = list(dict.fromkeys(point.algorithm for panel in panels for point in panel.points))
    looks = styles(algorithms)
    with mpl.rc_context(LOOK):
        figure = Figure(figsize=(max(3.4 * len(panels), 7.5), 4.2))
        FigureCanvasAgg(figure)
        drawn = figure.subplots(1, len(panels), squeeze=False)[0]
        labels = [_draw_panel(axes, panel, reference, looks) for axes, panel in zip(drawn, panels, strict=True)]
        drawn[0].set_ylabel("unsafe trials per 1,000")
        known = any(panel.title in reference for panel in panels)
        _legend(figure, {name: looks[name] for name in algorithms}, known)
        ConstrainedLayoutEngine().execute(figure)  # once: each drawing would lay it out anew
        for axes, panel, those in zip(drawn, panels, labels, strict=True):
            _spread(axes, panel, reference, those)
        svg, png = saved(figure)
        return Picture(name, caption, _named(svg, panels), png)


def _named(svg: str, panels: Iterable[Panel]) -> str:
    """Return a picture whose links say what they stand for, and stay on the page."""
    for title, point in ((panel.title, point) for panel in panels for point in panel.points):
        link = f'<a xlink:href="#{anchor(title, point.algorithm)}"'
        svg = svg.replace(f'{link} target="_blank">', f"{link}><title>{escape(point.words)}</title>")
    return svg


def _batch_points(paired: Paired) -> Iterable[Point]:
    batches = [paired.batches == batch for batch in np.unique(paired.batches)]
    for column, algorithm in enumerate(paired.algorithms):
        counted, unsafe, distance = paired.counted[:, column], paired.unsafe[:, column], paired.distance[:, column]
        metres = [distance[batch & paired.compared].mean() for batch in batches if (batch & paired.compared).any()]
        shares = [1000 * unsafe[batch & counted].mean() for batch in batches if (batch & counted).any()]
        yield Point(algorithm, _over(metres), _over(shares))


def _over(means: Sequence[float]) -> Span:
    """Return the batches' mean and, where there are several, its standard deviation to either side."""
    if not means:
        return math.nan, math.nan, math.nan
    value, spread = float(np.mean(means)), float(np.std(means, ddof=1)) if len(means) > 1 else 0.0
    return value - spread, value, value + spread


def styles(names: Sequence[str]) -> dict[str, Style]:
    found = dict.fromkeys([*ALGORITHMS, *names])  # the paper's always look the same
    return {name: Style(COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, name in enumerate(found)}


def _draw_panel(axes: Axes, panel: Panel, reference: Reference, styles: dict[str, Style]) -> list[Annotation]:
    axes.set_title(_drawable(panel.title), fontsize=10, parse_math=False)
    axes.set_xlabel("mean distance [m]")
    axes.grid(color=GRID)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(0.28, 0.16)  # room for a label on either side
    for algorithm, cell in reference.get(panel.title, {}).items():
        axes.add_line(styles[algorithm].mark(PAPER, cell.distance, cell.per_1000)).set_zorder(2)
    shown = [point for point in panel.points if math.isfinite(point.distance[1]) and math.isfinite(point.unsafe[1])]
    labels = [_draw_point(axes, panel.title, point, styles[point.algorithm]) for point in shown]
    axes.autoscale_view()
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, -0.06 * high))  # room for a label under 0, but no more: there are no shares below
    return labels


def _draw_point(axes: Axes, condition: str, point: Point, style: Style) -> Annotation:
    x, y = point.distance[1], point.unsafe[1]
    bars = [
        [[value - low], [high - value]] if math.isfinite(high - low) else None
        for low, value, high in (point.distance, point.unsafe)
    ]
    axes.errorbar(x, y, xerr=bars[0], yerr=bars[1], fmt="none", ecolor=style.colour, elinewidth=1, capsize=2, zorder=3)
    axes.add_line(style.mark(style.colour, x, y)).set_url(f"#{anchor(condition, point.algorithm)}")
    text = label(point.algorithm)
    note = axes.annotate(text, (x, y), xytext=PLACES[0], textcoords="offset points", fontsize=8, color=style.colour)
    note.set_parse_math(False)
    return note


def _spread(axes: Axes, panel: Panel, reference: Reference, labels: Sequence[Annotation]) -> None:
    """Move each label to the place beside its point that hides the least: points, bars and earlier labels."""
    taken = list(_obstacles(axes, panel, reference))
    for label in labels:

        def hidden(place: tuple[int, int], label: Annotation = label) -> int:
            label.set_position(place)
            label.set_horizontalalignment("left" if place[0] > 0 else "right")
            box = label.get_window_extent()
            inside = axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1
            return int(box.count_overlaps(taken)) + (0 if inside else len(taken))

        hidden(min(PLACES, key=hidden))  # the first of the best
        taken.append(label.get_window_extent())


def _obstacles(axes: Axes, panel: Panel, reference: Reference) -> Iterable[Bbox]:
    """Return what a label may not hide, in pixels: the paper's points, our points and their bars."""
    paper = [(cell.distance, cell.per_1000) for cell in reference.get(panel.title, {}).values()]
    for x, y in axes.transData.transform([*paper, *((p.distance[1], p.unsafe[1]) for p in panel.points)]):
        yield Bbox.from_bounds(x - 6, y - 6, 12, 12)
    for (left, x, right), (low, y, high) in ((point.distance, point.unsafe) for point in panel.points):
        for ends in (((left, y), (right, y)), ((x, low), (x, high))):
            (x0, y0), (x1, y1) = axes.transData.transform(ends)
            yield Bbox.from_extents(x0 - 2, y0 - 2, x1 + 2, y1 + 2)


def _legend(figure: Figure, styles: dict[str, Style], paper: bool) -> None:
    marks = {label(name): style.mark(style.colour) for name, style in styles.items()}
    if paper:
        marks["grey: the paper, same shapes"] = Style(PAPER, "o").mark(PAPER)
    legend = figure.legend(list(marks.values()), list(marks), loc="outside lower center", ncols=len(marks))
    for columns in range(len(marks) - 1, 0, -1):
        if legend.get_window_extent().width <= figure.bbox.width:
            break
        legend.remove()
        legend = figure.legend(list(marks.values()), list(marks), loc="outside lower center", ncols=columns)
    for text in legend.get_texts():
        text.set_parse_math(False)


def label(algorithm: str) -> str:
    """Return what an algorithm is called in a picture."""
    return LABELS.get(algorithm) or _drawable(algorithm)


def _drawable(name: str) -> str:
    """Return a name on one line, of a length that fits, without what no font can draw."""
    shown = "".join(letter for letter in " ".join(name.split()) if letter.isprintable())
    return shown if len(shown) <= LONGEST else f"{shown[: LONGEST - 3]}..."


def saved(figure: Figure) -> tuple[str, bytes]:
    """Return a figure as SVG and as PNG; to be called within LOOK."""
    svg, png = io.StringIO(), io.BytesIO()
    figure.savefig(svg, format="svg", metadata={"Date": None})
    figure.savefig(png, format="png", dpi=160)
    return svg.getvalue(), png.getvalue()
