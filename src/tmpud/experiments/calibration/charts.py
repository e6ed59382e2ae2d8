"""ROC curves and reliability diagrams of the predictors of an unsafe merge, one row for each source of merges."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from tmpud.experiments.calibration.measures import roc
from tmpud.experiments.calibration.predictions import Measured, Merges, Quality
from tmpud.experiments.calibration.scores import BASELINES
from tmpud.experiments.reports.charts import COLOURS, LOOK, PAPER, saved
from tmpud.experiments.reports.document import Picture
from tmpud.experiments.reports.table import interval
from tmpud.experiments.statistics.intervals import wilson

CAPTION = (
    "ROC curves with the area under each, and reliability diagrams: how often merges were unsafe (Wilson's 95 % "
    "intervals, number of merges) by the probability that 1 - Safe gave. Dotted: the share of all merges."
)
COLUMNS = 3  # of reliability diagrams beside the curves


def draw_calibration(found: Sequence[Measured]) -> Picture:
    """Draw what was measured, two rows of panels for each source."""
    with mpl.rc_context(LOOK):
        figure = Figure(figsize=(14, 6.2 * len(found)), layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.add_gridspec(2 * len(found), COLUMNS + 2)
        for row, (merges, qualities) in enumerate(found):
            _draw_roc(figure.add_subplot(grid[2 * row : 2 * row + 2, :2]), merges, qualities)
            with_bins = [(number, quality) for number, quality in enumerate(qualities) if quality.reliability]
            for place, (number, quality) in enumerate(with_bins[: 2 * COLUMNS]):
                panel = figure.add_subplot(grid[2 * row + place // COLUMNS, 2 + place % COLUMNS])
                _draw_reliability(panel, merges, quality, _style(number, quality.score)[0])
        return Picture("calibration", CAPTION, *saved(figure))


def _style(number: int, score: str) -> tuple[str, str]:
    return COLOURS[number % len(COLOURS)], "--" if score in BASELINES else "-" if number < len(COLOURS) else ":"


def _draw_roc(axes: Axes, merges: Merges, qualities: Sequence[Quality]) -> None:
    for number, quality in enumerate(qualities):
        curve = roc(merges.scores[quality.score], merges.unsafe)
        colour, line = _style(number, quality.score)
        label = f"{quality.score}: {interval(quality.area, 3)}"
        axes.plot(curve.false_alarms, curve.hits, line, color=colour, linewidth=1.6, label=label)
    n, unsafe = len(merges.unsafe), int(merges.unsafe.sum())
    axes.set_title(f"{merges.source}: {n} merges, {unsafe} unsafe", loc="left", fontsize=11)
    axes.set_xlabel("share of the safe merges refused")
    axes.set_ylabel("share of the unsafe merges refused")
    _square(axes)
    axes.legend(loc="lower right", fontsize=8, frameon=False, title="area under the curve [95 %]", title_fontsize=8)


def _draw_reliability(axes: Axes, merges: Merges, quality: Quality, colour: str) -> None:
    """Draw how often the merges of each bin were unsafe, with Wilson's intervals and the number of merges."""
    shares = [wilson(round(found.unsafe * found.n), found.n) for found in quality.reliability]
    x, y = [found.predicted for found in quality.reliability], [share.value for share in shares]
    ends = [[share.value - share.low for share in shares], [share.high - share.value for share in shares]]
    axes.errorbar(x, y, yerr=ends, fmt="o-", color=colour, markersize=4, linewidth=1.2)
    for found in quality.reliability:
        at = (found.predicted, found.unsafe)
        axes.annotate(f"{found.n}", at, (3, 4), textcoords="offset points", fontsize=7)
    axes.axhline(float(merges.unsafe.mean()), color=PAPER, linestyle=":", linewidth=1)
    axes.set_title(f"{quality.score}\nBrier {quality.brier:.3f}", loc="left", fontsize=9)
    axes.set_xlabel("1 - Safe", fontsize=8)
    axes.set_ylabel("share unsafe", fontsize=8)
    axes.tick_params(labelsize=7)
    _square(axes)


def _square(axes: Axes) -> None:
    axes.plot([0, 1], [0, 1], color=PAPER, linewidth=1)
    axes.set_xlim(-0.02, 1.02)
    axes.set_ylim(-0.02, 1.02)
    axes.set_aspect("equal")
    axes.spines[["top", "right"]].set_visible(False)
