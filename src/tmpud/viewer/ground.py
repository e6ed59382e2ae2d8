"""The road network as a replay draws it: whole centimetres, each line as its first point and then steps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, groupby, pairwise
from typing import Any

from tmpud.geometry import Point
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.symbols import Action

_LEFT_TO_RIGHT = (Action.TURNLEFT, Action.FORWARD, Action.TURNRIGHT)


def ground(network: RoadNetwork) -> dict[str, Any]:
    """Return edges with their streets' names, lanes, junctions and what stands at the stop lines."""
    numbers = {edge: number for number, edge in enumerate(network.edges)}
    return {
        "edges": [[edge, network.street_names.get(edge, "")] for edge in network.edges],
        "lanes": [_lane(network, name, numbers) for name in network.lanes],
        "junctions": [line(junction.shape) for junction in network.junctions.values() if len(junction.shape) > 2],
        "stops": [stop for name in network.lanes for stop in stops(network, name)],
    }


def line(points: Iterable[Point]) -> list[int]:
    """Return points as x, y, dx, dy, dx, dy, ... in whole centimetres."""
    whole = [(round(x * 100), round(y * 100)) for x, y in points]
    steps = ((x - before_x, y - before_y) for (before_x, before_y), (x, y) in pairwise(whole))
    return list(chain(whole[0], *steps)) if whole else []


def _lane(network: RoadNetwork, name: str, edges: Mapping[str, int]) -> list[Any]:
    """Return id, edge's number, width [cm], whether a lane of the road lies to its left and right, and the centre."""
    lane = network.lanes[name]
    beside = [int(network.neighbour(name, side) is not None) for side in (Action.MERGELEFT, Action.MERGERIGHT)]
    return [name, edges[lane.edge], round(lane.width * 100), *beside, line(lane.centre.points)]


def stops(network: RoadNetwork, name: str) -> list[list[Any]]:
    """Return the pieces of a lane's stop line, from the left: light, its letters' places, ends [cm].

    A piece stands for all connections of one action; lanes that no light controls have none.
    """
    lane = network.lanes[name]
    ways = sorted((way for way in network.outgoing(name) if way.signal is not None), key=_place)
    pieces = [(signal, [way.link for way in group]) for (_, signal), group in groupby(ways, key=_place)]
    found: list[list[Any]] = []
    for number, (signal, links) in enumerate(pieces):
        ends = [(0.5 - share / len(pieces)) * lane.width for share in (number, number + 1)]
        found.append([signal, links, *_across(lane.centre.pose_at, lane.length - 0.4, ends)])
    return found


def _across(pose_at: Any, station: float, offsets: Sequence[float]) -> list[int]:
    points = [pose_at(station, offset) for offset in offsets]
    return [round(value * 100) for point in points for value in (point.x, point.y)]


def _place(way: LaneConnection) -> tuple[int, str]:
    return _LEFT_TO_RIGHT.index(way.action), way.signal or ""
