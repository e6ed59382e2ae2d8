"""The connections of a SUMO net: their path through the junction, along internal lanes, and their light."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import Lane, LaneConnection
from tmpud.roads.vehicle_classes import open_to_cars
from tmpud.roads.xml_reading import Element, shown
from tmpud.symbols import Action

_ACTIONS = {
    "s": Action.FORWARD,
    "l": Action.TURNLEFT,
    "L": Action.TURNLEFT,
    "r": Action.TURNRIGHT,
    "R": Action.TURNRIGHT,
    "t": Action.TURNLEFT,
}
_STATES = frozenset("Mm=swoOZ-GgyYru")
_JOIN = 1.0  # [m] a step this short that turns back is rounding, not road

Place = tuple[str, int]  # an edge and the index of one of its lanes


@dataclass(slots=True)
class Links:
    """All connections of a net, and those of them that cars may use."""

    connections: list[LaneConnection] = field(default_factory=list)
    elements: list[Element] = field(default_factory=list)  # where each of ``connections`` stands
    leaving: dict[str, list[tuple[int | None, bool]]] = field(default_factory=dict)
    # lane -> its connections in the file's order: index in ``connections`` or None, and whether it counts as a link
    closed: int = 0
    turnarounds: int = 0


@dataclass(frozen=True, slots=True)
class _Reader:
    edges: Mapping[str, Element]
    rows: Mapping[str, Sequence[Element]]
    functions: Mapping[str, str]
    lanes: Mapping[str, Lane]
    shapes: Mapping[str, Element]  # lane id -> its element, internal lanes included
    onward: Mapping[tuple[str, str], Element]  # internal lane, edge it leads to -> the connection that goes on

    def end(self, element: Element, which: str) -> Element:
        """Return the lane element at one end (``from`` or ``to``) of a connection."""
        edge, index = element.text(which), element.natural(f"{which}Lane")
        if edge not in self.rows:
            raise element.error(f"{which}={shown(edge)} is not an edge of this net")
        if index >= len(self.rows[edge]):
            raise element.error(f"{which}Lane={index}: edge {shown(edge)} has {len(self.rows[edge])} lanes, from 0 on")
        return self.rows[edge][index]

    def internal_lanes(self, element: Element) -> list[str]:
        """Return the lanes through the junction, in driving order."""
        chain: list[str] = []
        step: Element | None = element
        while step is not None and (via := step.attributes.get("via")):
            if via not in self.shapes:
                raise step.error(f"via={shown(via)} is not a lane of this net")
            if via in chain:
                raise step.error(f"via={shown(via)} leads back to itself")
            chain.append(via)
            step = self.onward.get((via, element.text("to")))
        return chain

    def path(self, element: Element, chain: list[str]) -> Polyline:
        start = self.lanes[self.end(element, "from").text("id")].centre
        end = self.lanes[self.end(element, "to").text("id")].centre
        inner = [point for lane in chain for point in self.shapes[lane].points("shape")[0]]
        return joined(start, inner, end)

    def connection(self, element: Element) -> LaneConnection:
        chain = self.internal_lanes(element)
        direction = element.choice("dir", _ACTIONS)
        light = element.attributes.get("tl") or None
        return LaneConnection(
            from_lane=self.end(element, "from").text("id"),
            to_lane=self.end(element, "to").text("id"),
            action=_ACTIONS[direction],
            junction=self.edges[element.text("from")].text("to"),
            path=self.path(element, chain),
            internal_lanes=tuple(chain),
            signal=light,
            link=element.natural("linkIndex") if light else -1,
            priority=element.choice("state", _STATES, "M"),
            turnaround=direction == "t",
        )


def read_links(
    elements: Sequence[Element],
    edges: Mapping[str, Element],
    rows: Mapping[str, Sequence[Element]],
    functions: Mapping[str, str],
    lanes: Mapping[str, Lane],
    turnarounds: bool,
) -> Links:
    """Read the connections of a net; MapError where one names a lane that is not there, or stands twice."""
    shapes = {lane.text("id"): lane for row in rows.values() for lane in row}
    onward: dict[tuple[str, str], Element] = {}
    reader = _Reader(edges, rows, functions, lanes, shapes, onward)
    links = Links()
    for element in elements:
        lane = reader.end(element, "from").text("id")
        reader.end(element, "to")
        if functions[element.text("from")] == "internal":
            onward[lane, element.text("to")] = element
    seen: set[tuple[str, str]] = set()
    for element in elements:
        ends = reader.end(element, "from").text("id"), reader.end(element, "to").text("id")
        if ends in seen:
            raise element.error(f"lane {shown(ends[0])} is connected to {shown(ends[1])} twice")
        seen.add(ends)
        kinds = functions[element.text("from")], functions[element.text("to")]
        counts = kinds[1] == "crossing" or "walkingarea" not in kinds
        links.leaving.setdefault(ends[0], []).append((_add(links, reader, element, ends, kinds, turnarounds), counts))
    return links


def _add(
    links: Links, reader: _Reader, element: Element, ends: tuple[str, str], kinds: tuple[str, str], turnarounds: bool
) -> int | None:
    """Add a connection if cars may use it, and return its index."""
    if kinds != ("normal", "normal"):
        return None
    if element.choice("dir", _ACTIONS) == "t" and not turnarounds:
        links.turnarounds += 1
        return None
    if not (ends[0] in reader.lanes and ends[1] in reader.lanes and open_to_cars(element)):
        links.closed += 1
        return None
    links.connections.append(reader.connection(element))
    links.elements.append(element)
    return len(links.connections) - 1


def joined(start: Polyline, inner: Sequence[Point], end: Polyline) -> Polyline:
    """Return the way from the end of one lane through some points to the start of another.

    Points at which it turns back for a short step, since coordinates are rounded, are dropped. Lanes that touch get a
    path of at most 0.1 m along the second one.
    """
    way = [start.points[-2], start.points[-1]]
    last = end.points[0]
    for point in [*inner, last]:
        while len(way) > 2 and _is_kink(way[-2], way[-1], point):
            way.pop()
        if point == last or not _is_kink(way[-2], way[-1], point):
            way.append(point)
    try:
        return Polyline(way[1:])
    except ValueError:
        return Polyline([way[1], end.pose_at(min(0.1, end.length))[:2]])


def _is_kink(before: Point, here: Point, there: Point) -> bool:
    """Whether the way turns back at a point, and one of the two steps there is short."""
    if (there[0] - here[0]) * (here[0] - before[0]) + (there[1] - here[1]) * (here[1] - before[1]) > 0.0:
        return False
    return min(math.dist(before, here), math.dist(here, there)) <= _JOIN
