"""What a notebook shows of a road network, a plan and a safety estimate. No text of theirs is read as markup."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import singledispatch
from html import escape
from itertools import chain

from tmpud.events import Planned
from tmpud.geometry import Point
from tmpud.roads.network import RoadNetwork
from tmpud.safety.estimator import SafetyEstimate
from tmpud.symbols import TaskPlan
from tmpud.task.asp_planner import PlanReport

JUNCTION, ROAD, MARKING = "#b4b9c0", "#c9ccd1", "#ffffff"
WIDE = 640  # [px]
MOST_LANES = 20_000  # beyond it only the roads' rightmost lanes are drawn
Row = tuple[str, str, str, float, float]  # action, from, to, metres, safety term


@singledispatch
def svg(thing: object) -> str:
    """Return the picture of a network or an estimate as SVG."""
    raise TypeError(f"{type(thing).__name__} has no picture")


@singledispatch
def html(thing: object) -> str:
    """Return the table of a plan as HTML."""
    raise TypeError(f"{type(thing).__name__} has no table")


@svg.register
def _network(network: RoadNetwork) -> str:
    lanes = list(network.lanes.values())
    if len(lanes) > MOST_LANES:
        lanes = [lane for lane in lanes if lane.index == 0]
    shapes = [junction.shape for junction in network.junctions.values() if len(junction.shape) > 2]
    left, bottom, right, top = _bounds(chain.from_iterable([*shapes, *(lane.centre.points for lane in lanes)]))
    widths = sorted({lane.width for lane in lanes})
    drawn = [f'<path d="{"".join(f"{_path(shape)}Z" for shape in shapes)}" fill="{JUNCTION}"/>']
    for share, colour in ((1.0, MARKING), (0.94, ROAD)):  # what is left of the lower one are the markings
        for width in widths:
            lines = "".join(_path(lane.centre.points) for lane in lanes if lane.width == width)
            drawn.append(f'<path d="{lines}" fill="none" stroke="{colour}" stroke-width="{share * width:.2f}"/>')
    said = f"{network.name}: {len(network.lanes)} lanes, {len(network.junctions)} junctions"
    box = f"{left - 5:.1f} {-top - 5:.1f} {right - left + 10:.1f} {top - bottom + 10:.1f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDE}" viewBox="{box}" role="img">'
        f"<title>{_text(said)}</title>{''.join(drawn)}</svg>"
    )


@svg.register
def _estimate(estimate: SafetyEstimate) -> str:
    from tmpud.viewer.control_chart import draw_estimate  # takes its time

    return draw_estimate(estimate)


@html.register
def _report(report: PlanReport) -> str:
    proved = "optimal, proved by clingo" if report.optimal else "not proved optimal"
    rules = f" + {report.rules_m:.0f} m by the rules" if report.rules_m else ""
    total = f"{report.cost_m:.0f} m + {report.penalty_m:.0f} m safety term{rules}; {proved}"
    steps = report.steps or ((0.0, 0.0, 0.0),) * len(report.plan)
    return _table(report.plan, [step[0] for step in steps], [step[1] for step in steps], total)


@html.register
def _planned(event: Planned) -> str:
    total = f"at {event.time:.1f} s: {event.cost_m:.0f} m + {event.penalty_m:.0f} m safety term ({event.reason})"
    return _table(event.plan, event.cost, event.penalty, total)


def _table(plan: TaskPlan, metres: Iterable[float], penalties: Iterable[float], total: str) -> str:
    head = "".join(f"<th>{name}</th>" for name in ("action", "from", "to", "Cost [m]", "safety term [m]"))
    rows = "".join(
        f"<tr><td>{_text(step.action)}</td><td>{_text(step.state.segment)}</td>"
        f"<td>{_text(step.next_state.segment)}</td><td>{cost:.1f}</td><td>{penalty:.1f}</td></tr>"
        for step, cost, penalty in zip(plan, metres, penalties, strict=True)
    )
    return f"<table><caption>{_text(total)}</caption><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _bounds(points: Iterable[Point]) -> tuple[float, float, float, float]:
    xs, ys = zip(*points, strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _path(points: Sequence[Point]) -> str:
    """Return points as a path whose y axis points down, as SVG's does."""
    return "M" + "L".join(f"{x:.1f} {-y:.1f}" for x, y in points)


def _text(text: str) -> str:
    """Return text in which nothing is markup, without what XML cannot hold."""
    return escape("".join(letter for letter in text if letter.isprintable()).encode(errors="replace").decode())
