"""How a map's lanes hang together: all that can be told of a way without its course."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Protocol


class _Lane(Protocol):
    @property
    def edge(self) -> str: ...
    @property
    def index(self) -> int: ...
    @property
    def length(self) -> float: ...


class _Way(Protocol):
    @property
    def from_lane(self) -> str: ...
    @property
    def to_lane(self) -> str: ...


class Segment(NamedTuple):
    """The part of a lane between two stations; all lanes of a road are cut in the same number of parts."""

    id: str  # "<lane>/<number>", numbered from 0 along the lane
    lane: str
    number: int
    start: float  # [m] station on the lane
    end: float  # [m]

    @property
    def middle(self) -> float:
        return (self.start + self.end) / 2


@dataclass(frozen=True, slots=True)
class Graph:
    """Columns with one entry for each lane, and with one for each connection."""

    lanes: Sequence[str]  # their ids
    edges: Sequence[str]
    indices: Sequence[int]  # 0 is the rightmost lane of the edge
    lengths: Sequence[float]  # [m]
    starts: Sequence[int]  # which lane a connection starts from ...
    ends: Sequence[int]  # ... and to which one it leads, by their places in ``lanes``

    @classmethod
    def of(cls, lanes: Mapping[str, _Lane], ways: Iterable[_Way]) -> Graph:
        place = {lane: i for i, lane in enumerate(lanes)}
        own = zip(*((lane.edge, lane.index, lane.length) for lane in lanes.values()), strict=True)
        edges, indices, lengths = map(list, own) if lanes else ([], [], [])
        links = [(place[way.from_lane], place[way.to_lane]) for way in ways]
        return cls(list(lanes), edges, indices, lengths, [start for start, _ in links], [end for _, end in links])

    def by_edge(self) -> dict[str, tuple[str, ...]]:
        """Return the lanes of each edge, rightmost first."""
        rows: dict[str, list[tuple[int, str]]] = {}
        for lane, edge, index in zip(self.lanes, self.edges, self.indices, strict=True):
            rows.setdefault(edge, []).append((index, lane))
        return {edge: tuple(lane for _, lane in sorted(row)) for edge, row in rows.items()}

    def cut(self, by_edge: Mapping[str, Sequence[str]], longest: float) -> dict[str, tuple[Segment, ...]]:
        """Return the segments of each lane, none longer than ``longest`` [m], as many on each lane of an edge."""
        length = dict(zip(self.lanes, self.lengths, strict=True))
        most = {edge: max(length[lane] for lane in lanes) for edge, lanes in by_edge.items()}
        pieces = {edge: max(1, math.ceil(metres / longest - 1e-9)) for edge, metres in most.items()}
        return {lane: _cut(lane, length[lane], pieces[e]) for lane, e in zip(self.lanes, self.edges, strict=True)}

    def ways(self) -> Iterator[tuple[str, str]]:
        """Yield the lanes that the connections join."""
        return ((self.lanes[start], self.lanes[end]) for start, end in zip(self.starts, self.ends, strict=True))

    def ways_at(self, places: Sequence[int]) -> dict[str, list[int]]:
        """Return for each lane which connections have it, with ``places`` one of ``starts`` and ``ends``."""
        rows: list[list[int]] = [[] for _ in self.lanes]
        for index, place in enumerate(places):
            rows[place].append(index)
        return dict(zip(self.lanes, rows, strict=True))


def _cut(lane: str, length: float, pieces: int) -> tuple[Segment, ...]:
    ends = [length * number / pieces for number in range(pieces + 1)]
    return tuple(Segment(f"{lane}/{i}", lane, i, start, end) for i, (start, end) in enumerate(pairwise(ends)))
