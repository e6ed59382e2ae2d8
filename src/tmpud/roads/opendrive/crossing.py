"""Who crosses whose path in a junction, and who goes first: OpenDRIVE leaves it to signs and to the law.

As far as the file says nothing else: whoever has a sign (stop, give way) waits for those without; whoever turns left
waits for those who come towards him; else whoever comes from the right goes first (Vienna Convention, Article 18).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from tmpud.geometry import Polyline, wrap_angle
from tmpud.roads.network import LaneConnection
from tmpud.roads.opendrive.lanes import Row
from tmpud.roads.opendrive.links import by_junction
from tmpud.symbols import Action

CLEARANCE = 2.4  # [m] two paths closer than this share the place
_RANK = {"M": 2, "m": 1, "s": 0}

Priorities = Mapping[str, frozenset[tuple[int, int]]]


def with_right_of_way(
    connections: Sequence[LaneConnection], inner: Sequence[Row], priorities: Priorities
) -> tuple[LaneConnection, ...]:
    """Return the connections with ``foes`` and ``yields_to`` filled in; their ``priority`` is known already."""
    foes: list[list[int]] = [[] for _ in connections]
    yields: list[list[int]] = [[] for _ in connections]
    for name, indices in by_junction(connections).items():
        lines = {index: connections[index].path.resampled(1.0) for index in indices}
        for place, first in enumerate(indices):
            for second in indices[place + 1 :]:
                if connections[first].from_lane == connections[second].from_lane or not _meet(
                    lines[first], lines[second]
                ):
                    continue
                foes[first].append(second)
                foes[second].append(first)
                pairs = _named(inner[first], inner[second], priorities.get(name, frozenset()))
                waits = pairs or _waits(connections[first], connections[second])
                if waits:
                    yields[first if waits > 0 else second].append(second if waits > 0 else first)
    return tuple(
        replace(connection, foes=tuple(sorted(foes[i])), yields_to=tuple(sorted(yields[i])))
        for i, connection in enumerate(connections)
    )


def _meet(one: Polyline, other: Polyline) -> bool:
    """Whether two sampled paths share a place."""
    return any(math.dist(a, b) < CLEARANCE for a in one.points for b in other.points)


def _named(first: Row, second: Row, priorities: frozenset[tuple[int, int]]) -> int:
    """Return 1 where the file lets the first one wait, -1 where the second, 0 where it says nothing."""
    for a in first:
        for b in second:
            if (a.road, b.road) in priorities:
                return -1
            if (b.road, a.road) in priorities:
                return 1
    return 0


def _waits(first: LaneConnection, second: LaneConnection) -> int:
    """Return 1 where the first one waits for the second, -1 the other way round, 0 where neither does."""
    by_sign = _RANK[second.priority] - _RANK[first.priority]
    if by_sign:
        return 1 if by_sign > 0 else -1
    apart = wrap_angle(_heading(second.path) - _heading(first.path))
    left = (first.action is Action.TURNLEFT) - (second.action is Action.TURNLEFT)
    if abs(apart) > math.radians(135):  # they come towards each other
        return left
    if abs(apart) > math.radians(45):
        return 1 if apart > 0.0 else -1  # who drives to my left comes from my right
    straight = (first.action is not Action.FORWARD) - (second.action is not Action.FORWARD)
    return straight or -1  # side by side into one lane: whoever goes straight on, else the first


def _heading(path: Polyline) -> float:
    return path.pose_at(0.0).heading
