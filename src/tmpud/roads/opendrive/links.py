"""Connections from strands: from the end of each lane, through a junction or straight on, to the starts of others."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from tmpud.geometry import Polyline, wrap_angle
from tmpud.roads.network import LaneConnection
from tmpud.roads.opendrive.lanes import LaneParts, Row, Strands, distinct, simplified
from tmpud.roads.opendrive.strands import Key
from tmpud.roads.sumo_links import joined
from tmpud.symbols import Action

STRAIGHT = math.radians(45)  # a way that bends by less is straight on
STRAIGHTER = math.radians(10)  # ... unless another way from the same lane bends by this much less
BACK = math.radians(155)  # a way that bends by more is a turnaround
_LONGEST = 50  # [strands] no way through a junction has more

Way = tuple[str, str, Row]  # from lane, to lane, the strands in between


def read_links(lanes: Sequence[LaneParts], strands: Strands) -> tuple[list[LaneConnection], list[Row], int]:
    """Return the connections, the strands of each, and how many turnarounds were left out."""
    starts = {each.parts[0]: each.lane.id for each in lanes}
    found: list[LaneConnection] = []
    inner: list[Row] = []
    turnarounds = 0
    curves = {each.lane.id: each.lane.centre for each in lanes}
    for each in lanes:
        ways = _shortest(_ways(each.lane.id, each.parts[-1], starts, strands), strands)
        paths = [_path(curves, way, strands) for way in ways]
        bends = [bend(path, curves[way[0]], curves[way[1]]) for way, path in zip(ways, paths, strict=True)]
        least = min(map(abs, bends), default=0.0)
        for way, path, angle in zip(ways, paths, bends, strict=True):
            if abs(angle) > BACK:
                turnarounds += 1
                continue
            found.append(_connection(way, path, _action(angle, least), strands))
            inner.append(way[2])
    return found, inner, turnarounds


def _ways(lane: str, last: Key, starts: Mapping[Key, str], strands: Strands) -> Iterator[Way]:
    """Yield the ways from a lane's last strand to other lanes."""
    work: list[Row] = [(key,) for key in strands[last].successors]
    while work:
        *passed, here = work.pop()
        if here in starts:
            yield lane, starts[here], tuple(passed)
        elif strands[here].junction and len(passed) < _LONGEST and here not in passed:
            work += [(*passed, here, onward) for onward in strands[here].successors]


def _shortest(ways: Iterator[Way], strands: Strands) -> list[Way]:
    """Return one way for each pair of lanes, in the order of the lanes' names."""
    best: dict[str, Way] = {}
    for way in sorted(ways, key=lambda way: (way[1], sum(len(strands[key].points) for key in way[2]), way[2])):
        best.setdefault(way[1], way)
    return list(best.values())


def _path(curves: Mapping[str, Polyline], way: Way, strands: Strands) -> Polyline:
    start, end = curves[way[0]], curves[way[1]]
    points = [start.points[-1], *(point for key in way[2] for point in strands[key].points), end.points[0]]
    apart = [points[i] for i in distinct(points)]
    if len(apart) == 1:
        return Polyline([points[0], end.pose_at(min(0.1, end.length))[:2]])
    inner = [apart[i] for i in simplified(apart, [0.0] * len(apart))][1:-1]
    return joined(start, inner, end)


def bend(path: Polyline, start: Polyline, end: Polyline) -> float:
    """Return by how much one turns to the left on a way from one lane to another [rad], whole turns included."""
    inner = [math.atan2(y1 - y0, x1 - x0) for (x0, y0), (x1, y1) in pairwise(path.points)]
    headings = [start.pose_at(start.length).heading, *inner, end.pose_at(0.0).heading]
    return sum(wrap_angle(there - here) for here, there in pairwise(headings))


def _action(angle: float, least: float) -> Action:
    if abs(angle) < STRAIGHT and abs(angle) - least < STRAIGHTER:
        return Action.FORWARD
    return Action.TURNLEFT if angle > 0.0 else Action.TURNRIGHT


def _connection(way: Way, path: Polyline, action: Action, strands: Strands) -> LaneConnection:
    """Return a connection; where no junction lies between the lanes, where they meet is named after the second."""
    junction = strands[way[2][0]].junction if way[2] else way[1]
    return LaneConnection(way[0], way[1], action, junction, path, tuple(map(str, way[2])))


def by_junction(connections: Sequence[LaneConnection]) -> dict[str, list[int]]:
    """Return the indices of the connections through each junction."""
    found: dict[str, list[int]] = defaultdict(list)
    for index, connection in enumerate(connections):
        found[connection.junction].append(index)
    return found
