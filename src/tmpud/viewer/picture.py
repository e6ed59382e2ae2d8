"""The picture of a run: the town, the plans in their colours, the driven path, and where Safe was low."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Planned
from tmpud.geometry import Point
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path import find_path, outline
from tmpud.presets import PRESETS
from tmpud.roads.network import RoadNetwork
from tmpud.story import plan_name
from tmpud.symbols import Place, ServiceRequest, State, TaskPlan

LOW = 0.5  # estimates below this are marked
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # told apart by the colour-blind
ROAD, JUNCTION, MARKING, DRIVEN = "#c9ccd1", "#bfc3c9", "#ffffff", "#1a1a1a"
MOST_PLANS = 5  # drawn


def draw_run(network: RoadNetwork, events: Iterable[Event], file: Path) -> None:
    """Draw a run's picture into a PNG or SVG file."""
    log = list(events)
    header = next(event for event in log if isinstance(event, Header))
    mapping = _mapping(network, header)
    figure = Figure(figsize=(11, 8.5), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    draw_network(axes, network)
    plans = [event for event in log if isinstance(event, Planned)]
    for number, planned in enumerate(plans[:MOST_PLANS]):
        _draw_plan(axes, plan_outline(network, mapping, planned.plan), planned, number)
    _draw_driven(axes, log)
    _draw_estimates(axes, log)
    _draw_ends(axes, mapping, plans)
    _draw_scale(axes)
    axes.set_title(_title(header, log), loc="left", fontsize=11)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False, fontsize=9)
    figure.savefig(file, dpi=130)


def draw_network(axes: Axes, network: RoadNetwork) -> None:
    """Draw lanes, lane markings and junctions, to scale."""
    axes.set_aspect("equal")
    axes.axis("off")
    shapes = [junction.shape for junction in network.junctions.values() if len(junction.shape) > 2]
    axes.add_collection(PolyCollection(shapes, facecolors=JUNCTION, edgecolors="none", zorder=0))
    bands = [_band(lane.centre.points, lane.width) for lane in network.lanes.values()]
    axes.add_collection(PolyCollection(bands, facecolors=ROAD, edgecolors=MARKING, linewidths=0.4, zorder=1))
    axes.autoscale_view()


def plan_outline(network: RoadNetwork, mapping: StateMapping, plan: TaskPlan) -> list[Point]:
    """Return the points of the path a plan drives."""
    points: list[Point] = []
    for step in plan:
        moves = find_path(network, mapping(step.state), mapping(step.next_state), step.action) or ()
        for move in moves:
            points += outline(move)
    return points


def _band(points: Iterable[Point], width: float) -> list[Point]:
    """Return the outline of a lane."""
    from tmpud.geometry import Polyline

    line = Polyline(points)
    poses = [line.pose_at(station) for station in line.stations]
    left = [(line.pose_at(s, width / 2).x, line.pose_at(s, width / 2).y) for s in line.stations]
    right = [(line.pose_at(s, -width / 2).x, line.pose_at(s, -width / 2).y) for s in line.stations]
    return [*left, *right[::-1]] if poses else []


def _mapping(network: RoadNetwork, header: Header) -> StateMapping:
    mission = header.mission
    words = mission["request"]
    request = ServiceRequest(_place(words["start"]), tuple(_place(goal) for goal in words["goals"]))
    return StateMapping(network, request, PRESETS[mission["preset"]], mission["seed"])


def _place(words: Any) -> Place:
    return Place(words["name"], tuple(words["segments"]), words["station"])


def _draw_plan(axes: Axes, points: list[Point], planned: Planned, number: int) -> None:
    if not points:
        return
    label = f"plan {plan_name(number)}: {planned.cost_m:.0f} m + {planned.penalty_m:.0f} m penalty"
    x, y = zip(*points, strict=True)
    width = 7.0 - 1.2 * number  # later plans are thinner, so that the ones below them stay visible
    axes.plot(x, y, color=COLOURS[number], linewidth=width, alpha=0.75, solid_capstyle="round", label=label, zorder=3)


def _draw_driven(axes: Axes, log: list[Event]) -> None:
    rows = [event.ego for event in log if isinstance(event, Frame)]
    if rows:
        x, y = [row[0] / 100 for row in rows], [row[1] / 100 for row in rows]
        axes.plot(x, y, color=DRIVEN, linewidth=1.2, label="driven", zorder=5)


def _draw_estimates(axes: Axes, log: list[Event]) -> None:
    low = [event for event in log if isinstance(event, Estimated) and event.safe < LOW and event.trajectory]
    if low:
        x, y = [e.trajectory[0][1] for e in low], [e.trajectory[0][2] for e in low]
        axes.scatter(x, y, s=160, facecolors="none", edgecolors="#c00000", linewidths=2, label="Safe was low", zorder=6)
        for event, ex, ey in zip(low, x, y, strict=True):
            text = f"{event.step.action}: Safe {event.safe:.2f}"
            axes.annotate(
                text, (ex, ey), xytext=(8, 10), textcoords="offset points", fontsize=8, color="#c00000", zorder=7
            )
    judged = [event for event in log if isinstance(event, Judged)]
    where = {event.time: event.ego for event in log if isinstance(event, Frame)}
    spots = [where[min(where, key=lambda t: abs(t - event.time))] for event in judged] if where else []
    if spots:
        x, y = [spot[0] / 100 for spot in spots], [spot[1] / 100 for spot in spots]
        axes.scatter(x, y, s=120, marker="X", color="#c00000", label="judged unsafe", zorder=8)


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


def _draw_scale(axes: Axes) -> None:
    """Draw a bar of 100 m into the lower left corner."""
    (x, _), (y, _) = axes.get_xlim(), axes.get_ylim()
    axes.add_collection(LineCollection([[(x, y), (x + 100, y)]], colors="#111111", linewidths=3, zorder=9))
    axes.annotate("100 m", (x + 50, y), xytext=(0, 4), textcoords="offset points", ha="center", fontsize=9)


def _title(header: Header, log: list[Event]) -> str:
    mission = header.mission
    end = next((event for event in log if isinstance(event, Finished)), None)
    result = f": {end.status}, {end.distance:.0f} m in {end.travel_time:.0f} s, {end.replans} replans" if end else ""
    done = sum(isinstance(event, Executed) for event in log)
    return f"{header.map['name']}, {mission['algorithm']}, seed {mission['seed']}{result}, {done} actions"
