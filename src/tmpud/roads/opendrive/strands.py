"""The lanes of a ``carla.Map``: one strand for each (road, section, lane) of its topology."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import median
from typing import Any, NamedTuple

from tmpud.geometry import Point
from tmpud.roads.carla_coordinates import to_heading, to_point
from tmpud.roads.opendrive.facts import Road

SAME = 1e-3  # [m] points closer than this are one
WITHIN = 1e-5  # [m]
NARROWEST = 0.5  # [m] a lane that is mostly narrower is none
STEP = 1.0  # [m] between the waypoints that are looked at


class Key(NamedTuple):
    """How OpenDRIVE names a part of a lane; right lanes, which lead along the road, are negative."""

    road: int
    section: int
    lane: int

    def __str__(self) -> str:
        return f"{self.road}.{self.section}.{self.lane}"


@dataclass(frozen=True, slots=True)
class Strand:
    """A driving lane of one lane section, sampled in driving order."""

    key: Key
    junction: str  # "" outside of junctions
    span: tuple[float, float]  # [m] the road's station s at its start and at its end, in driving order
    points: tuple[Point, ...]
    elevation: tuple[float, ...]  # [m] at each point
    width: float  # [m] the median
    successors: tuple[Key, ...]


@dataclass(frozen=True, slots=True)
class Mark:
    """A light or sign, on one of the roads for which it counts."""

    id: str
    kind: str  # OpenDRIVE's type: 1000001 a light, 205 give way, 206 stop
    road: int
    s: float  # [m]
    lanes: tuple[tuple[int, int], ...]  # from, to: the ranges of lanes for which it counts

    def holds_for(self, key: Key) -> bool:
        return self.road == key.road and any(min(pair) <= key.lane <= max(pair) for pair in self.lanes)


def read_strands(town: Any, roads: Mapping[int, Road]) -> dict[Key, Strand]:
    """Return the driving lanes of a ``carla.Map``, those through junctions included.

    The topology names a start once for each of its successors, and a lane without one only as another's successor.
    Nothing is asked for that ends the process on a sound map: a waypoint's ``lane_change`` where a lane has no road
    mark, ``next_until_lane_end`` where a lane ends.
    """
    starts: dict[Key, Any] = {}
    successors: dict[Key, dict[Key, None]] = {}
    for here, there in town.get_topology():
        starts.setdefault(_key(here), here)
        starts.setdefault(_key(there), there)
        successors.setdefault(_key(here), {})[_key(there)] = None
    found = {
        key: _strand(town, starts[key], _span(key, roads), tuple(successors.get(key, ()))) for key in sorted(starts)
    }
    wide = {key for key, strand in found.items() if strand.width >= NARROWEST}
    return {
        key: replace(found[key], successors=tuple(onward for onward in found[key].successors if onward in wide))
        for key in sorted(wide)
    }


def read_marks(town: Any) -> list[Mark]:
    """Return the lights and signs, once for each road on which they stand or to which the map says they belong."""
    marks = (
        Mark(each.id, each.type, each.road_id, each.s, tuple(each.get_lane_validities()))
        for each in town.get_all_landmarks()
    )
    return sorted(set(marks), key=lambda mark: (mark.road, mark.s, mark.id, mark.lanes))


def _key(waypoint: Any) -> Key:
    return Key(waypoint.road_id, waypoint.section_id, waypoint.lane_id)


def _span(key: Key, roads: Mapping[int, Road]) -> tuple[float, float]:
    """Return the stations on the road at which a lane starts and ends, in driving order [m]."""
    if key.road not in roads or key.section >= len(roads[key.road].sections):
        raise ValueError(f"lane {key} is on no road of the file")
    road = roads[key.road]
    start, end = road.sections[key.section], road.section_end(key.section)
    return (start, end) if key.lane < 0 else (end, start)


def _strand(town: Any, start: Any, span: tuple[float, float], successors: tuple[Key, ...]) -> Strand:
    """Return a lane from its first waypoint and what the map says between the ends of its span."""
    key = _key(start)
    row = list(_distinct([_waypoint(town, key, s) for s in _stations(*span)]))
    if len(row) == 1:
        row.append((row[0][0], _ahead(row[0][0])))
    if math.dist(row[0][1], row[-1][1]) > STEP:  # no ring: a left lane without an exit is said to lead to itself
        successors = tuple(successor for successor in successors if successor != key)
    return Strand(
        key=key,
        junction=str(start.junction_id) if start.is_junction else "",
        span=span,
        points=tuple(point for _, point in row),
        elevation=tuple(waypoint.transform.location.z for waypoint, _ in row),
        width=median(waypoint.lane_width for waypoint, _ in row),
        successors=successors,
    )


def _stations(first: float, last: float) -> Iterator[float]:
    """Yield stations from just within one end to just within the other: at an end itself the next lane may be found."""
    within = math.copysign(min(WITHIN, abs(last - first) / 4), last - first)
    first, last = first + within, last - within
    pieces = max(1, math.ceil(abs(last - first) / STEP))
    return (first + (last - first) * i / pieces for i in range(pieces + 1))


def _waypoint(town: Any, key: Key, s: float) -> Any:
    found = town.get_waypoint_xodr(key.road, key.lane, s)
    if found is None or _key(found) != key:
        raise ValueError(f"lane {key} is not there at s={s:g}")
    return found


def _distinct(waypoints: Sequence[Any]) -> Iterator[tuple[Any, Point]]:
    """Yield waypoints with their points, without those that lie where the one before lies."""
    before: Point | None = None
    for waypoint in waypoints:
        point = _point(waypoint)
        if before is None or math.dist(before, point) > SAME:
            yield waypoint, point
            before = point


def _point(waypoint: Any) -> Point:
    location = waypoint.transform.location
    if not all(math.isfinite(value) for value in (location.x, location.y, location.z)):
        raise ValueError(f"a point of lane {_key(waypoint)} is not finite")
    return to_point(location.x, location.y)


def _ahead(waypoint: Any) -> Point:
    """Return a point just ahead, for a lane that has no length of its own."""
    x, y = _point(waypoint)
    heading = to_heading(waypoint.transform.rotation.yaw)
    return x + 2 * SAME * math.cos(heading), y + 2 * SAME * math.sin(heading)
