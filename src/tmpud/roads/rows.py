"""A road network in the types of JSON, and back: how it is cached, and how a child process hands it over."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from tmpud.geometry import Point, Polyline
from tmpud.roads.graph import Graph
from tmpud.roads.late import BLOCK, Block, Late, Named, Row, rows_of
from tmpud.roads.network import WHOLE, Frame, Junction, Lane, LaneConnection, RoadNetwork, SignalProgram, Stretch
from tmpud.symbols import Action

_KINDS = "map", "graph", "lanes", "connections", "junctions", "signals", "parts"


def map_name(path: Path) -> str:
    """Return what a map from a file is called."""
    return path.name.removesuffix(".gz").removesuffix(".xml").removesuffix(".net").removesuffix(".xodr")


def to_rows(network: RoadNetwork) -> Iterator[tuple[str, list[Row]]]:
    """Yield a network in the types of JSON, some rows at a time; connections name lanes by their number."""
    graph = network.graph
    yield "map", [[network.digest, _values(network.frame), network.warnings, network.street_names]]
    yield "graph", [_values(graph)]
    ends = zip(graph.starts, graph.ends, network.connections, strict=True)
    kinds: dict[str, Iterator[Row]] = {
        "lanes": map(_lane_row, network.lanes.values()),
        "connections": (_values(way, from_lane=start, to_lane=end, path=way.path.points) for start, end, way in ends),
        "junctions": map(_values, network.junctions.values()),
        "signals": map(_values, network.signals.values()),
        "parts": map(list, network.parts.items()),
    }
    for kind, rows in kinds.items():
        while block := list(islice(rows, BLOCK)):
            yield kind, block


def _values(item: Any, **instead: Any) -> Row:
    return [instead.get(field.name, getattr(item, field.name)) for field in fields(item)]


def from_rows(blocks: Iterable[tuple[str, Block]], file: Path, segment_length: float) -> RoadNetwork:
    """Return the network; its lanes and connections become objects when they are first asked for."""
    found: dict[str, list[Block]] = {kind: [] for kind in _KINDS}
    for kind, block in blocks:
        found[kind].append(block)
    ((digest, (offset, projection), warnings, street_names),) = rows_of(found["map"][0])
    graph = Graph(*rows_of(found["graph"][0])[0])
    connections = Late(found["connections"], len(graph.starts), partial(_connection, graph.lanes))
    network = RoadNetwork(
        name=map_name(file),
        lanes=Named(graph.lanes, Late(found["lanes"], len(graph.lanes), _lane)),
        connections=connections,
        junctions={row[0]: _junction(*row) for block in found["junctions"] for row in rows_of(block)},
        signals={row[0]: _signal(*row) for block in found["signals"] for row in rows_of(block)},
        frame=Frame((offset[0], offset[1]), projection),
        source=str(file),
        digest=digest,
        warnings=tuple(warnings),
        parts={part: lane for block in found["parts"] for part, lane in rows_of(block)},
        segment_length=segment_length,
        street_names=street_names,
    )
    network.graph = graph
    return network


def _lane_row(lane: Lane) -> Row:
    changes = {name: _finite(getattr(lane, name)) for name in ("change_left", "change_right")}
    return _values(lane, centre=lane.centre.points, **changes)


def _finite(stretches: tuple[Stretch, ...]) -> Row | None:
    """Return stretches with None for the end of any lane, as JSON has no infinity, and for the whole of one."""
    if stretches == WHOLE:
        return None
    return [(start, None if math.isinf(end) else end) for start, end in stretches]


def _lane(name: str, edge: str, index: int, centre: Row, elevation: Row, *others: Any) -> Lane:
    width, speed, left, right = others
    return Lane(
        name, edge, index, Polyline(centre), tuple(elevation), width, speed, _stretches(left), _stretches(right)
    )


def _stretches(row: Row | None) -> tuple[Stretch, ...]:
    if row is None:
        return WHOLE
    return tuple(Stretch(start, math.inf if end is None else end) for start, end in row)


def _connection(
    ids: Sequence[str], start: int, end: int, action: str, junction: str, path: Row, *others: Any
) -> LaneConnection:
    internal, signal, link, priority, turnaround, yields_to, foes = others
    return LaneConnection(
        ids[start],
        ids[end],
        Action(action),
        junction,
        Polyline(path),
        tuple(internal),
        signal,
        link,
        priority,
        turnaround,
        tuple(yields_to),
        tuple(foes),
    )


def _junction(name: str, kind: str, x: float, y: float, shape: Row) -> Junction:
    return Junction(name, kind, x, y, _points(shape))


def _signal(name: str, offset: float, phases: Row, lights: Row) -> SignalProgram:
    return SignalProgram(name, offset, tuple((duration, state) for duration, state in phases), tuple(lights))


def _points(row: Row) -> tuple[Point, ...]:
    return tuple((x, y) for x, y in row)
