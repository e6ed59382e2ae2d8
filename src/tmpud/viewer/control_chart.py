"""The picture of a safety estimate: o_i(t), and the controls that are safe beside the vehicle that sets Safe."""

from __future__ import annotations

import io
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from tmpud.safety.control_set import Controls, HalfPlane, SafeSets
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import FloatArray
from tmpud.viewer.picture import RISK, fitting

CELLS = 61  # along each axis of Delta x Theta
LOOK: dict[Any, Any] = {"svg.hashsalt": "tmpud", "text.parse_math": False, "font.size": 9}  # equal ones: equal files
OTHER = "#9aa0a8"


def draw_estimate(estimate: SafetyEstimate) -> str:
    """Return an SVG; of an estimate that was drawn and not made, or of no vehicle, only what it says."""
    with mpl.rc_context(LOOK):
        shown = estimate.sets is not None and len(estimate.ids) > 0
        figure = Figure(figsize=(9.0, 2.9) if shown else (4.0, 0.5), layout="constrained")
        worst = f", set by {fitting(estimate.worst, 40)}" if estimate.worst else ", no vehicle counts"
        figure.suptitle(f"Safe = {estimate.safe:.2f}{worst}", x=0.01, ha="left", fontsize=10)
        if shown and estimate.sets is not None and estimate.worst is not None:
            row = estimate.ids.index(estimate.worst)
            shares, instant, horizon = figure.subplots(1, 3)
            _draw_shares(shares, estimate, row)
            _draw_controls(instant, horizon, estimate, estimate.sets, row)
        page = io.StringIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(page, metadata={"Date": None})
    text = page.getvalue()
    return text[text.index("<svg") :]


def _draw_shares(axes: Axes, estimate: SafetyEstimate, row: int) -> None:
    for number, shares in enumerate(estimate.o):
        worst = number == row
        axes.plot(
            estimate.times, shares, color=RISK if worst else OTHER, linewidth=2.0 if worst else 1.0, zorder=2 + worst
        )
    axes.set(xlabel="t [s]", ylim=(-0.03, 1.03), title="o_i(t)")


def _draw_controls(instant: Axes, horizon: Axes, estimate: SafetyEstimate, sets: SafeSets, row: int) -> None:
    """Draw which controls are safe at a bad instant, and at how many instants each is."""
    excess = _excess(sets, row)
    worst = _telling(estimate.o[row])
    extent = (*np.degrees(sets.controls.turning[::-1]), *sets.controls.acceleration)
    unit = "steering [°]" if sets.controls.steering else "yaw rate [°/s]"
    for axes, shares in ((instant, excess[worst] <= 0.0), (horizon, (excess <= 0.0).mean(axis=0))):
        image = axes.imshow(
            shares[:, ::-1].astype(float), origin="lower", aspect="auto", extent=extent, vmin=0.0, vmax=1.0
        )
        axes.set(xlabel=f"left   {unit}   right", ylabel="acceleration [m/s²]")
    _cut(instant, sets.controls, excess[worst])
    instant.set_title(f"safe (light) at t = {estimate.times[worst]:.2f} s", fontsize=9)
    horizon.set_title("share of instants it is safe at", fontsize=9)
    horizon.figure.colorbar(image, ax=horizon)


def _telling(shares: FloatArray) -> int:
    """Return the worst instant at which some controls are safe and some are not, else the worst one."""
    split = (shares > 0.0) & (shares < 1.0)
    return int(np.where(split, shares, 2.0).argmin() if split.any() else shares.argmin())


def _grid(controls: Controls) -> tuple[FloatArray, FloatArray]:
    return np.linspace(*controls.acceleration, CELLS)[:, None], np.linspace(*controls.turning, CELLS)[None, :]


def _half_plane(sets: SafeSets, row: int) -> HalfPlane:
    """Return a vehicle's half-plane at each instant (T, 1, 1); its limit is infinite where every control is safe."""
    rows = []
    for values, elsewhere in zip(sets.plane, (np.inf, 0.0, 0.0), strict=True):
        whole = np.full(sets.cut.shape, elsewhere)
        whole[sets.cut] = values
        rows.append(whole[row][:, None, None])
    return HalfPlane(*rows)


def _excess(sets: SafeSets, row: int) -> FloatArray:
    """Return by how much each control is beyond what is safe (T, CELLS, CELLS); at most 0: it is safe."""
    acceleration, turn = _grid(sets.controls)
    plane = _half_plane(sets, row)
    effect = np.tan(turn) if sets.controls.steering else turn
    return np.asarray(plane.by_acceleration * acceleration + plane.by_turning * effect - plane.limit)


def _cut(axes: Axes, controls: Controls, excess: FloatArray) -> None:
    """Draw the line that cuts off what is not safe."""
    if not excess.min() <= 0.0 < excess.max():
        return
    acceleration, turn = _grid(controls)
    axes.contour(np.degrees(turn[0]), acceleration[:, 0], excess, levels=[0.0], colors=[RISK], linewidths=2.0)
