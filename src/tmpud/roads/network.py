"""The road network: lanes cut into segments, their neighbours, and the connections through junctions."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from tmpud.geometry import Point, Polyline
from tmpud.roads.graph import Graph, Segment
from tmpud.showing import ShownAsSvg
from tmpud.symbols import Action

SEGMENT_LENGTH = 60.0  # [m]

_OPPOSITE = {Action.MERGELEFT: Action.MERGERIGHT, Action.MERGERIGHT: Action.MERGELEFT}


class Stretch(NamedTuple):
    """A part of a lane, in stations [m]."""

    start: float
    end: float


WHOLE = (Stretch(0.0, math.inf),)  # the whole of any lane
NOWHERE: tuple[Stretch, ...] = ()


@dataclass(frozen=True, slots=True)
class Lane:
    """One lane of a road (edge), open to cars."""

    id: str
    edge: str
    index: int  # 0 is the rightmost lane of the edge
    centre: Polyline
    elevation: tuple[float, ...]  # [m] z at each point of ``centre``
    width: float  # [m]
    speed: float  # [m/s] limit
    change_left: tuple[Stretch, ...] = WHOLE  # where cars may leave it to the left
    change_right: tuple[Stretch, ...] = WHOLE

    @property
    def length(self) -> float:
        return self.centre.length

    @property
    def level(self) -> float:
        """Mean elevation [m]."""
        return sum(self.elevation) / len(self.elevation)


@dataclass(frozen=True, slots=True)
class LaneConnection:
    """One permitted way from the end of a lane through a junction to the start of another lane."""

    from_lane: str
    to_lane: str
    action: Action  # forward, turnleft or turnright
    junction: str
    path: Polyline  # from the end of ``from_lane`` to the start of ``to_lane``
    internal_lanes: tuple[str, ...]  # the source's ids of the lanes that make up ``path``
    signal: str | None = None  # id of the light that controls it
    link: int = -1  # which letter of that light's state is its own
    priority: str = "M"  # the source's right-of-way letter: M, m, =, s (stop), w (all-way stop), o, O
    turnaround: bool = False
    yields_to: tuple[int, ...] = ()  # connections (indices in RoadNetwork.connections) that go first
    foes: tuple[int, ...] = ()  # connections whose paths it crosses or joins


@dataclass(frozen=True, slots=True)
class Junction:
    id: str
    kind: str  # traffic_light, priority, right_before_left, dead_end, ...
    x: float
    y: float
    shape: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class SignalProgram:
    id: str
    offset: float  # [s]
    phases: tuple[tuple[float, str], ...]  # (duration [s], one letter per link)
    lights: tuple[str, ...] = ()  # the source's id of what shows each letter, where it has several


@dataclass(frozen=True, slots=True)
class Frame:
    """How the map's coordinates relate to its source's: map = source + offset."""

    offset: Point = (0.0, 0.0)  # [m]
    projection: str = "!"


@dataclass
class RoadNetwork(ShownAsSvg):
    """Lanes, lane segments, connections, junctions and signals of one map. Not changed after it is built.

    What can be looked up in it is worked out when it is first asked for.
    """

    name: str
    lanes: Mapping[str, Lane]
    connections: Sequence[LaneConnection]
    junctions: Mapping[str, Junction]
    signals: Mapping[str, SignalProgram]
    frame: Frame = field(default_factory=Frame)
    source: str = ""  # the file it was read from
    digest: str = ""  # sha256 of that file
    warnings: tuple[str, ...] = ()
    parts: Mapping[str, str] = field(default_factory=dict)  # the source's id of a part of a lane -> the lane
    segment_length: float = SEGMENT_LENGTH  # [m] longest segment; inf: one per lane
    street_names: Mapping[str, str] = field(default_factory=dict)  # edge -> what its signs say, where it is known

    @cached_property
    def graph(self) -> Graph:
        """How the lanes hang together."""
        return Graph.of(self.lanes, self.connections)

    @cached_property
    def edges(self) -> dict[str, tuple[str, ...]]:
        """The lanes of each edge, rightmost first."""
        return self.graph.by_edge()

    @cached_property
    def segments(self) -> dict[str, Segment]:
        """All segments by their ids."""
        return {segment.id: segment for cut in self._cuts.values() for segment in cut}

    @cached_property
    def internal(self) -> dict[str, int]:
        """The index of the connection to which a lane through a junction belongs."""
        return {lane: index for index, way in enumerate(self.connections) for lane in way.internal_lanes}

    @cached_property
    def _cuts(self) -> dict[str, tuple[Segment, ...]]:
        return self.graph.cut(self.edges, self.segment_length)

    @cached_property
    def _outgoing(self) -> dict[str, list[int]]:
        return self.graph.ways_at(self.graph.starts)

    @cached_property
    def _incoming(self) -> dict[str, list[int]]:
        return self.graph.ways_at(self.graph.ends)

    @cached_property
    def _index(self) -> dict[tuple[str, str], int]:
        return {ends: index for index, ends in enumerate(self.graph.ways())}

    def segments_of(self, lane: str) -> tuple[Segment, ...]:
        """Return a lane's segments in driving order."""
        return self._cuts[lane]

    def segment_at(self, lane: str, station: float) -> Segment:
        """Return the segment of a lane on which a station lies."""
        cut = self._cuts[lane]
        return cut[max(bisect_right(cut, station, key=lambda segment: segment.start) - 1, 0)]

    def ahead(self, segment: str) -> Segment | None:
        """Return the next segment of the same lane, None at the lane's end."""
        here = self.segments[segment]
        cut = self._cuts[here.lane]
        return cut[here.number + 1] if here.number + 1 < len(cut) else None

    def behind(self, segment: str) -> Segment | None:
        """Return the segment before it on the same lane, None at the lane's start."""
        here = self.segments[segment]
        return self._cuts[here.lane][here.number - 1] if here.number else None

    def beside(self, segment: str, action: Action) -> Segment | None:
        """Return the segment left (mergeleft) or right (mergeright) of it on the same road, None at its edge."""
        here = self.segments[segment]
        neighbour = self.neighbour(here.lane, action)
        return self._cuts[neighbour.id][here.number] if neighbour else None

    def neighbour(self, lane: str, action: Action) -> Lane | None:
        """Return the lane left (mergeleft) or right (mergeright) of a lane on the same road."""
        here = self.lanes[lane]
        row = self.edges[here.edge]
        place = row.index(lane) + (1 if action is Action.MERGELEFT else -1)
        if not 0 <= place < len(row):
            return None
        there = self.lanes[row[place]]
        return there if abs(there.index - here.index) == 1 else None

    def may_change(self, lane: str, action: Action) -> bool:
        """Whether cars may anywhere leave a lane to its left (mergeleft) or right (mergeright)."""
        here = self.lanes[lane]
        allowed = here.change_left if action is Action.MERGELEFT else here.change_right
        return bool(allowed) and self.neighbour(lane, action) is not None

    def open_from(self, lane: str, action: Action, station: float, length: float) -> Stretch | None:
        """Return where from a station on cars may first leave a lane, for some length [m] at least; None if nowhere."""
        here = self.lanes[lane]
        for start, end in here.change_left if action is Action.MERGELEFT else here.change_right:
            begin = max(start, station)
            if end - begin >= length:
                return Stretch(begin, end)
        return None

    def merge_target(self, segment: str, action: Action) -> Segment | None:
        """Return where a merge from a segment leads: the neighbouring lane's next segment, None where not offered.

        Where lanes are not cut (one segment per lane), it is the neighbouring lane itself.
        """
        there = self.beside(segment, action)
        if there is None or not self.may_change(self.segments[segment].lane, action):
            return None
        return there if self.uncut else self.ahead(there.id)

    def merge_origin(self, segment: str, action: Action) -> Segment | None:
        """Return from where a merge leads to a segment, None where no merge does."""
        before = self.segments[segment] if self.uncut else self.behind(segment)
        here = before and self.beside(before.id, _OPPOSITE[action])
        return here if here and self.merge_target(here.id, action) else None

    @property
    def uncut(self) -> bool:
        """Whether each lane is one segment."""
        return math.isinf(self.segment_length)

    def outgoing(self, lane: str) -> list[LaneConnection]:
        """Return the connections that start at a lane's end."""
        return [self.connections[index] for index in self._outgoing[lane]]

    def leads_to(self, lane: str) -> list[str]:
        """Return the lanes to which a lane leads."""
        return [self.graph.lanes[self.graph.ends[index]] for index in self._outgoing[lane]]

    def incoming(self, lane: str) -> list[LaneConnection]:
        """Return the connections that end at a lane's start."""
        return [self.connections[index] for index in self._incoming[lane]]

    def index_of(self, connection: LaneConnection) -> int:
        """Return the place of a connection in ``connections``, by which others name it."""
        return self._index[connection.from_lane, connection.to_lane]

    def locate(self, x: float, y: float) -> tuple[Lane, float, float]:
        """Return the lane nearest to a point, the station on it and the offset to its left [m]."""
        found = ((lane, *lane.centre.project(x, y)) for lane in self.lanes.values())
        return min(found, key=lambda hit: (abs(hit[2]), hit[0].id))
