"""A road network from an OpenDRIVE file, by CARLA's own parser: the steps in their order, for a child process."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from tmpud.errors import MapError
from tmpud.geometry import Point, Polyline
from tmpud.roads.network import Frame, Junction, LaneConnection, RoadNetwork
from tmpud.roads.opendrive.crossing import with_right_of_way
from tmpud.roads.opendrive.facts import Facts, read_facts
from tmpud.roads.opendrive.lanes import LaneParts, Strands, read_lanes
from tmpud.roads.opendrive.links import by_junction, read_links
from tmpud.roads.opendrive.signals import LIGHTS, Lookup, program, with_signals
from tmpud.roads.opendrive.strands import Mark, Strand, read_marks, read_strands
from tmpud.roads.rows import map_name

_GEO = re.compile(r"<geoReference>\s*(?:<!\[CDATA\[)?(.*?)(?:\]\]>)?\s*</geoReference>", re.DOTALL)


def read_town(path: Path) -> RoadNetwork:
    """Read a file by ``carla.Map``; MapError where it cannot be read. A damaged one may end the process."""
    import carla

    facts = read_facts(path)
    text = path.read_text(encoding="utf-8-sig")
    try:
        town = carla.Map(map_name(path), text)
        strands, marks = read_strands(town, facts.roads), read_marks(town)
        if all(strand.junction for strand in strands.values()):
            raise ValueError("there is no lane outside of junctions on which cars drive")
        return _network(path, facts, strands, marks, _frame(text))
    except ValueError as error:
        raise MapError(str(path), None, f"{error}") from error
    except (RuntimeError, LookupError, OverflowError, MemoryError) as error:
        raise MapError(str(path), None, f"CARLA's parser cannot read it: {error}") from error


def _network(path: Path, facts: Facts, strands: Strands, marks: Sequence[Mark], frame: Frame) -> RoadNetwork:
    lanes = list(read_lanes(strands, facts.roads))
    links, inner, turnarounds = read_links(lanes, strands)
    links, lights = with_signals(links, inner, lanes, Lookup(marks, strands))
    connections = with_right_of_way(links, inner, facts.priorities)
    return RoadNetwork(
        name=map_name(path),
        lanes={each.lane.id: each.lane for each in lanes},
        connections=connections,
        junctions={each.id: each for each in _junctions(strands, connections, lights)},
        signals={name: program(name, order, facts.controllers.get(name, ())) for name, order in lights.items()},
        frame=frame,
        source=str(path),
        digest=facts.digest,
        warnings=tuple(_warnings(lanes, connections, turnarounds, marks, lights)),
        parts={str(part): each.lane.id for each in lanes for part in each.parts},
    )


def _frame(text: str) -> Frame:
    """Return the map's frame: its own coordinates, which are CARLA's but for the sign of y."""
    found = _GEO.search(text)
    return Frame((0.0, 0.0), found[1].strip() if found and found[1].strip() else "!")


def _junctions(
    strands: Strands, connections: Sequence[LaneConnection], lights: Mapping[str, object]
) -> Iterator[Junction]:
    """Yield the junctions, with the convex hull of their lanes, and the places where a lane goes on as another."""
    inside: dict[str, list[Point]] = {}
    for strand in strands.values():
        if strand.junction:
            inside.setdefault(strand.junction, []).extend(_sides(strand))
    for name, indices in by_junction(connections).items():
        shape = hull(inside.get(name, ()))
        x, y = _middle(shape or [connections[index].path.points[0] for index in indices])
        yield Junction(name, "traffic_light" if name in lights else "priority" if shape else "joint", x, y, shape)


def _sides(strand: Strand) -> Iterator[Point]:
    """Yield points along both edges of a lane."""
    centre, half = Polyline(strand.points), strand.width / 2
    return (centre.pose_at(station, side)[:2] for station in centre.stations for side in (half, -half))


def _middle(points: Sequence[Point]) -> Point:
    return sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)


def hull(points: Iterable[Point]) -> tuple[Point, ...]:
    """Return the convex hull, counter-clockwise (Andrew 1979); empty for no points."""
    chain: list[Point] = []
    ordered = sorted(set(points))
    for row in (ordered, ordered[::-1]):
        base = len(chain)
        for point in row:
            while len(chain) >= base + 2 and _turn(chain[-2], chain[-1], point) <= 0.0:
                chain.pop()
            chain.append(point)
        chain = chain[:-1]
    return tuple(chain)


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return whether one turns left (> 0) or right (< 0) at the second of three points."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def _warnings(
    lanes: Sequence[LaneParts],
    connections: Sequence[LaneConnection],
    turnarounds: int,
    marks: Sequence[Mark],
    lights: Mapping[str, Sequence[str]],
) -> Iterator[str]:
    names = {each.lane.id for each in lanes}
    used = {light for order in lights.values() for light in order}
    counts = [
        (turnarounds, "turnarounds, left out"),
        (len({mark.id for mark in marks if mark.kind in LIGHTS} - used), "lights that no lane has, left out"),
        (len(names - {each.from_lane for each in connections}), "lanes without an exit"),
        (len(names - {each.to_lane for each in connections}), "lanes without an entry"),
    ]
    return (f"{what}: {count}" for count, what in counts if count)
