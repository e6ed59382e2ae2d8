"""A tiny road network: two lanes eastwards through a junction that a one-lane road crosses northwards.

Eastwards in_0 (y = 0) and in_1 (y = 3.2) run over x = 0..100, out_0 and out_1 over x = 120..220, limit 50 km/h.
Northwards side_0 (x = 110) runs over y = -100..-10, north_0 over y = 10..100, limit 18 km/h.
"""

from __future__ import annotations

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import Lane, LaneConnection, RoadNetwork
from tmpud.symbols import Action

WIDTH = 3.2  # [m]


def _lane(name: str, start: Point, end: Point, speed: float = 50 / 3.6) -> Lane:
    edge, index = name.split("_")
    return Lane(name, edge, int(index), Polyline([start, end]), (0.0, 0.0), WIDTH, speed)


def _way(link: int, start: str, end: str, action: Action, points: list[Point], priority: str) -> LaneConnection:
    internal = (f":J_{link}_0",)
    return LaneConnection(start, end, action, "J", Polyline(points), internal, "J", link, priority)


def crossroads(side_priority: str = "m") -> RoadNetwork:
    """Return the network; links 0 and 1 go straight on, 2 turns left, 3 crosses, 4 turns right from the side."""
    lanes = [
        _lane("in_0", (0, 0), (100, 0)),
        _lane("in_1", (0, WIDTH), (100, WIDTH)),
        _lane("out_0", (120, 0), (220, 0)),
        _lane("out_1", (120, WIDTH), (220, WIDTH)),
        _lane("side_0", (110, -100), (110, -10), 5.0),
        _lane("north_0", (110, 10), (110, 100), 5.0),
    ]
    ways = (
        _way(0, "in_0", "out_0", Action.FORWARD, [(100, 0), (120, 0)], "M"),
        _way(1, "in_1", "out_1", Action.FORWARD, [(100, WIDTH), (120, WIDTH)], "M"),
        _way(2, "in_1", "north_0", Action.TURNLEFT, [(100, WIDTH), (108, WIDTH + 2), (110, 10)], "M"),
        _way(3, "side_0", "north_0", Action.FORWARD, [(110, -10), (110, 10)], side_priority),
        _way(4, "side_0", "out_0", Action.TURNRIGHT, [(110, -10), (112, -2), (120, 0)], side_priority),
    )
    return RoadNetwork("crossroads", {lane.id: lane for lane in lanes}, ways, {}, {}, segment_length=50.0)
