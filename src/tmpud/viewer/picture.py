"""The picture of a run: the town, the plans in their colours, the driven path, and where Safe was low."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Planned, Refused
from tmpud.geometry import Point, Polyline, Pose
from tmpud.motion.mapping import StateMapping
from tmpud.roads.network import RoadNetwork
from tmpud.story import plan_name
from tmpud.symbols import State
from tmpud.viewer.paths import mapping_of, plan_outline

LOW = 0.5  # estimates below this are marked, and those that led to another plan
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # told apart by the colour-blind
ROAD, JUNCTION, MARKING, DRIVEN = "#c9ccd1", "#bfc3c9", "#ffffff", "#1a1a1a"
CAR, RISK = "#6b7280", "#c00000"
MOST_PLANS = 5  # drawn
ZOOM = 45.0  # [m] either side of the ego
MOMENTS = 2  # shown close by


@dataclass(frozen=True, slots=True)
class Area:
    """A rectangle of the map [m]."""

    left: float
    bottom: float
    right: float
    top: float

    @classmethod
    def around(cls, points: Iterable[Point], margin: float) -> Area:
        xs, ys = zip(*points, strict=True)
        return cls(min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin)

    def touches(self, points: Iterable[Point]) -> bool:
        """Whether the rectangle around the points lies partly within it."""
        other = Area.around(points, 0.0)
        apart = other.right < self.left or self.right < other.left or other.top < self.bottom or self.top < other.bottom
        return not apart


EVERYWHERE = Area(-math.inf, -math.inf, math.inf, math.inf)


def draw_run(network: RoadNetwork, events: Iterable[Event], file: Path) -> None:
    """Draw a run's picture into a PNG or SVG file."""
    log = list(events)
    header = next(event for event in log if isinstance(event, Header))
    mapping = mapping_of(network, header)
    figure = Figure(figsize=(13, 8.5), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(1 + MOMENTS, 2, width_ratios=(3, 2))
    town = figure.add_subplot(grid[:, 0])
    moments = {figure.add_subplot(grid[row, 1]): low for row, low in enumerate(_low(log)[:MOMENTS], 1)}
    plans = [event for event in log if isinstance(event, Planned)]
    for axes in (town, *moments):
        draw_network(axes, network)
        for number, planned in enumerate(plans[:MOST_PLANS]):
            _draw_plan(axes, plan_outline(network, mapping, planned.plan), planned, number)
        _draw_driven(axes, log)
    _draw_estimates(town, log)
    _draw_ends(town, mapping, plans)
    _draw_scale(town, 100)
    for axes, low in moments.items():
        _draw_moment(axes, low, log)
    figure.suptitle(_title(header, log), x=0.01, ha="left", fontsize=12)
    handles, labels = town.get_legend_handles_labels()
    if handles:
        legend = figure.add_subplot(grid[0, 1])
        legend.axis("off")
        legend.legend(handles, labels, loc="upper left", frameon=False, fontsize=10, title="The whole town (left)")
    figure.savefig(file, dpi=110)


def draw_network(axes: Axes, network: RoadNetwork, within: Area = EVERYWHERE) -> None:
    """Draw the lanes, lane markings and junctions of an area, to scale."""
    axes.set_aspect("equal")
    axes.axis("off")
    shapes = [junction.shape for junction in network.junctions.values() if len(junction.shape) > 2]
    shapes = [shape for shape in shapes if within.touches(shape)]
    axes.add_collection(PolyCollection(shapes, facecolors=JUNCTION, edgecolors="none", zorder=0))
    lanes = (lane for lane in network.lanes.values() if within.touches(lane.centre.points))
    bands = [band(lane.centre.points, lane.width) for lane in lanes]
    axes.add_collection(PolyCollection(bands, facecolors=ROAD, edgecolors=MARKING, linewidths=0.4, zorder=1))
    axes.autoscale_view()


def band(points: Iterable[Point], width: float) -> list[Point]:
    """Return the outline of a lane."""
    line = Polyline(points)
    left = [(line.pose_at(s, width / 2).x, line.pose_at(s, width / 2).y) for s in line.stations]
    right = [(line.pose_at(s, -width / 2).x, line.pose_at(s, -width / 2).y) for s in line.stations]
    return [*left, *right[::-1]]


def _draw_plan(axes: Axes, points: list[Point], planned: Planned, number: int) -> None:
    if not points:
        return
    label = f"plan {plan_name(number)}: {planned.cost_m:.0f} m + {planned.penalty_m:.0f} m penalty"
    x, y = zip(*points, strict=True)
    width = 9.0 - 1.7 * number  # later plans are thinner, so that the ones below them stay visible
    axes.plot(x, y, color=COLOURS[number], linewidth=width, solid_capstyle="round", label=label, zorder=3)


def _draw_driven(axes: Axes, log: list[Event]) -> None:
    rows = [event.ego for event in log if isinstance(event, Frame)]
    if rows:
        x, y = [row[0] / 100 for row in rows], [row[1] / 100 for row in rows]
        axes.plot(x, y, color=DRIVEN, linewidth=1.2, label="driven", zorder=5)


def _low(log: list[Event]) -> list[Estimated]:
    """Return the estimates that were low, or low enough for another plan."""
    refused = {(event.time, event.step) for event in log if isinstance(event, Refused)}
    estimates = (event for event in log if isinstance(event, Estimated) and event.trajectory)
    return [event for event in estimates if event.safe < LOW or (event.time, event.step) in refused]


def _draw_estimates(axes: Axes, log: list[Event]) -> None:
    low = _low(log)
    if low:
        x, y = [e.trajectory[0][1] for e in low], [e.trajectory[0][2] for e in low]
        axes.scatter(x, y, s=160, facecolors="none", edgecolors=RISK, linewidths=2, label="Safe was low", zorder=6)
        for event, ex, ey in zip(low, x, y, strict=True):
            text = f"{event.step.action}: Safe {event.safe:.2f}"
            note = axes.annotate(
                text, (ex, ey), xytext=(8, 10), textcoords="offset points", fontsize=8, color=RISK, zorder=7
            )
            note.set_path_effects([withStroke(linewidth=3, foreground="white")])  # it may lie upon a plan
    judged = [event for event in log if isinstance(event, Judged) and event.kind in ("collision", "forced_stop")]
    where = {event.time: event.ego for event in log if isinstance(event, Frame)}
    spots = [where[min(where, key=lambda t: abs(t - event.time))] for event in judged] if where else []
    if spots:
        x, y = [spot[0] / 100 for spot in spots], [spot[1] / 100 for spot in spots]
        axes.scatter(x, y, s=120, marker="X", color=RISK, label="judged unsafe", zorder=8)


def _draw_ends(axes: Axes, mapping: StateMapping, plans: list[Planned]) -> None:
    first = next((planned.plan for planned in plans if planned.plan), ())
    ends: list[tuple[str, str, State]] = []
    if first:
        ends = [("start", "o", first[0].state), ("goal", "*", first[-1].next_state)]
    for label, marker, state in ends:
        pose = mapping.pose(state)
        axes.scatter(
            [pose.x], [pose.y], s=150, marker=marker, color="#111111", edgecolors="white", label=label, zorder=9
        )


def _draw_scale(axes: Axes, length: float) -> None:
    """Draw a bar of a length [m] into the lower left corner."""
    (x, _), (y, _) = axes.get_xlim(), axes.get_ylim()
    axes.add_collection(LineCollection([[(x, y), (x + length, y)]], colors="#111111", linewidths=3, zorder=9))
    label = f"{length:g} m"
    axes.annotate(label, (x + length / 2, y), xytext=(0, 4), textcoords="offset points", ha="center", fontsize=9)


def _draw_moment(axes: Axes, low: Estimated, log: list[Event]) -> None:
    """Zoom in on an estimate that was low: the ego, the cars around it, and the one that is the risk."""
    frame = next((e for e in log if isinstance(e, Frame) and e.time >= low.time), None)
    if frame is None:
        axes.set_visible(False)
        return
    cars = dict(zip(frame.ids, frame.others, strict=True))
    axes.add_collection(PolyCollection([_box(row) for row in cars.values()], facecolors=CAR, zorder=6))
    axes.add_collection(PolyCollection([_box(frame.ego)], facecolors=DRIVEN, zorder=7))
    if low.worst in cars:
        axes.add_collection(PolyCollection([_box(cars[low.worst])], facecolors=RISK, zorder=7))
    x, y = frame.ego[0] / 100, frame.ego[1] / 100
    axes.set_xlim(x - ZOOM, x + ZOOM)
    axes.set_ylim(y - ZOOM / 2, y + ZOOM / 2)
    _draw_scale(axes, 10)
    what = f"{low.time:.1f} s: Safe({low.step.action}) = {low.safe:.2f}"
    axes.set_title(f"{what}\nego black, nearest risk {low.worst} red", loc="left", fontsize=10)


def _box(row: tuple[int, int, int, int]) -> list[Point]:
    """Return the outline of a car of usual size from a frame's row."""
    pose = Pose(row[0] / 100, row[1] / 100, row[2] / 1000)
    ex, ey = math.cos(pose.heading), math.sin(pose.heading)
    corners = ((2.4, 0.9), (2.4, -0.9), (-2.4, -0.9), (-2.4, 0.9))
    return [(pose.x + a * ex - b * ey, pose.y + a * ey + b * ex) for a, b in corners]


def _title(header: Header, log: list[Event]) -> str:
    mission = header.mission
    end = next((event for event in log if isinstance(event, Finished)), None)
    replans = f"{end.replans} replan{'s' * (end.replans != 1)}" if end else ""
    result = f": {end.status}, {end.distance:.0f} m in {end.travel_time:.0f} s, {replans}" if end else ""
    done = sum(isinstance(event, Executed) for event in log)
    return f"{header.map['name']}, {mission['algorithm']}, seed {mission['seed']}{result}, {done} actions"


def fitting(text: str, letters: int) -> str:
    """Return text that fits into a line and has a glyph for each letter."""
    shown = "".join(letter for letter in text if letter.isprintable()).encode("latin-1", "replace").decode("latin-1")
    return shown if len(shown) <= letters else shown[: letters - 1] + "…"
