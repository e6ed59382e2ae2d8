"""Lanes from strands: the sections of a road are joined wherever nothing but their number changes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import Lane, Stretch
from tmpud.roads.opendrive.facts import Road
from tmpud.roads.opendrive.strands import SAME, Key, Strand

JUMP = 50.0  # [m] no two points of a lane that follow one another are further apart
TOLERANCE = 0.02  # [m] by which a lane's centre line may miss a point that the map gives

Row = tuple[Key, ...]  # the lanes of one side of a section, rightmost first
Strands = Mapping[Key, Strand]


class LaneParts(NamedTuple):
    """A lane, and the strands of which it is made, in driving order."""

    lane: Lane
    parts: Row


def read_lanes(strands: Strands, roads: Mapping[int, Road]) -> Iterator[LaneParts]:
    """Yield the lanes outside of junctions; rows of them that lead on one to one are one edge."""
    rows = _rows(strands)
    following = _following(rows, strands)
    followed = set(following.values())
    starts = [row for row in rows if row not in followed] + rows  # a ring has no start: any of its rows
    done: set[Row] = set()
    for start in starts:
        chain: list[Row] = []
        row: Row | None = start
        while row is not None and row not in done:
            done.add(row)
            chain.append(row)
            row = following.get(row)
        for parts in zip(*chain, strict=True):
            yield LaneParts(_lane(parts, chain[0], strands, roads), parts)


def _rows(strands: Strands) -> list[Row]:
    sides: dict[tuple[int, int, bool], list[Key]] = {}
    for key, strand in strands.items():
        if not strand.junction:
            sides.setdefault((key.road, key.section, key.lane < 0), []).append(key)
    return [tuple(sorted(side, key=lambda key: -abs(key.lane))) for side in sides.values()]


def _following(rows: Iterable[Row], strands: Strands) -> dict[Row, Row]:
    """Return the row that goes on each row: lane by lane, with the same gaps, and nothing else leads there."""
    row_of = {key: row for row in rows for key in row}
    before: dict[Key, int] = {}
    for strand in strands.values():
        for successor in strand.successors:
            before[successor] = before.get(successor, 0) + 1
    found: dict[Row, Row] = {}
    for row in rows:
        onward = [strands[key].successors for key in row]
        if any(len(successors) != 1 for successors in onward):
            continue
        there = row_of.get(onward[0][0])
        if there is None or there is row or [successors[0] for successors in onward] != list(there):
            continue
        if all(before[key] == 1 for key in there) and _gaps(row) == _gaps(there):
            found[row] = there
    return found


def _gaps(row: Row) -> list[int]:
    return [abs(a.lane) - abs(b.lane) for a, b in pairwise(row)]


def _lane(parts: Row, row: Row, strands: Strands, roads: Mapping[int, Road]) -> Lane:
    first, row_of = parts[0], [strands[part] for part in parts]
    points = [point for strand in row_of for point in strand.points]
    elevation = [z for strand in row_of for z in strand.elevation]
    apart = distinct(points)
    points, elevation = [points[i] for i in apart], [elevation[i] for i in apart]
    kept = simplified(points, elevation)
    centre = Polyline(points[i] for i in kept)
    samples = sum(len(strand.points) for strand in row_of)
    return Lane(
        id=str(first),
        edge=f"{first.road}.{first.section}.{'right' if first.lane < 0 else 'left'}",
        index=abs(row[0].lane) - abs(first.lane),
        centre=centre,
        elevation=tuple(elevation[i] for i in kept),
        width=sum(strand.width * len(strand.points) for strand in row_of) / samples,
        speed=min(roads[part.road].limit(part.section, part.lane) for part in parts),
        change_left=_open(row_of, roads, centre.length, inward=True),
        change_right=_open(row_of, roads, centre.length, inward=False),
    )


def _open(parts: Sequence[Strand], roads: Mapping[int, Road], length: float, *, inward: bool) -> tuple[Stretch, ...]:
    """Return where on a lane of some length the road marks let cars leave it: towards the road's middle, or away."""
    lengths = [max(abs(strand.span[1] - strand.span[0]), SAME) for strand in parts]
    scale = length / sum(lengths)
    found: list[Stretch] = []
    begin = 0.0
    for strand, own in zip(parts, lengths, strict=True):
        for start, end in sorted(_crossable(strand, roads[strand.key.road], inward=inward)):
            start, end = begin + min(max(start, 0.0), own), begin + min(end, own)
            if found and start * scale - found[-1].end < SAME:
                found[-1] = Stretch(found[-1].start, end * scale)
            elif end > start:
                found.append(Stretch(start * scale, end * scale))
        begin += own
    if found and found[-1].end > length - SAME:
        found[-1] = Stretch(found[-1].start, math.inf)
    return tuple(found)


def _crossable(strand: Strand, road: Road, *, inward: bool) -> Iterator[tuple[float, float]]:
    """Yield from where to where in driving order, from the strand's start [m], cars may leave it.

    The border towards the road's middle is the next inner lane's.
    """
    lane = strand.key.lane
    sign = 1 if lane > 0 else -1
    border = lane - sign if inward else lane
    change = "increase" if inward == (lane < 0) else "decrease"
    first = strand.span[0]
    for start, end in road.crossable(strand.key.section, border, change):
        yield (start - first, end - first) if lane < 0 else (first - end, first - start)


def distinct(points: Sequence[Point]) -> list[int]:
    """Return which points to keep so that none lies where the one before does; ValueError where one is far from it."""
    kept: list[int] = []
    for i, point in enumerate(points):
        step = math.dist(points[kept[-1]], point) if kept else math.inf
        if kept and step > JUMP:
            raise ValueError(f"a lane goes on {step:.0f} m from where it ends, at {point[0]:.1f},{point[1]:.1f}")
        if step > SAME:
            kept.append(i)
    return kept


def simplified(points: Sequence[Point], elevation: Sequence[float]) -> list[int]:
    """Return which points to keep so that none left out lies further than TOLERANCE away, in the plane or in height.

    Douglas and Peucker 1973, without recursion.
    """
    keep = {0, len(points) - 1}
    work = [(0, len(points) - 1)]
    while work:
        first, last = work.pop()
        worst = max(range(first + 1, last), key=lambda i: _off(points, elevation, (first, i, last)), default=first)
        if worst != first and _off(points, elevation, (first, worst, last)) > TOLERANCE:
            keep.add(worst)
            work += [(first, worst), (worst, last)]
    return sorted(keep)


def _off(points: Sequence[Point], elevation: Sequence[float], indices: tuple[int, int, int]) -> float:
    """Return how far a point is from the line between two others, or its height from theirs [m]."""
    (x0, y0), (x, y), (x1, y1) = (points[i] for i in indices)
    z0, z, z1 = (elevation[i] for i in indices)
    dx, dy, length = x1 - x0, y1 - y0, math.dist((x0, y0), (x1, y1))
    if length == 0.0:
        return math.dist((x0, y0), (x, y))
    along = min(max(((x - x0) * dx + (y - y0) * dy) / length**2, 0.0), 1.0)
    return max(math.dist((x, y), (x0 + along * dx, y0 + along * dy)), abs(z - z0 - along * (z1 - z0)))
