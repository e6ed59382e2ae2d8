"""A road network in the types of JSON, and back: how it is cached, and how a child process hands it over."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import WHOLE, Frame, Junction, Lane, LaneConnection, RoadNetwork, SignalProgram, Stretch
from tmpud.symbols import Action

_BLOCK = 1_000  # [rows] that are handed over at a time

Row = list[Any]


def map_name(path: Path) -> str:
    """Return what a map from a file is called."""
    return path.name.removesuffix(".gz").removesuffix(".xml").removesuffix(".net").removesuffix(".xodr")


def to_rows(network: RoadNetwork) -> Iterator[tuple[str, list[Row]]]:
    """Yield a network in the types of JSON, some rows at a time; connections name lanes by their number."""
    number = {lane: i for i, lane in enumerate(network.lanes)}
    yield "map", [[network.digest, _values(network.frame), network.warnings, network.street_names]]
    kinds = {
        "lanes": map(_lane_row, network.lanes.values()),
        "connections": (
            _values(each, from_lane=number[each.from_lane], to_lane=number[each.to_lane], path=each.path.points)
            for each in network.connections
        ),
        "junctions": map(_values, network.junctions.values()),
        "signals": map(_values, network.signals.values()),
        "parts": map(list, network.parts.items()),
    }
    for kind, rows in kinds.items():
        while block := list(islice(rows, _BLOCK)):
            yield kind, block


def _values(item: Any, **instead: Any) -> Row:
    return [instead.get(field.name, getattr(item, field.name)) for field in fields(item)]


def from_rows(blocks: Iterable[tuple[str, list[Row]]], file: Path, segment_length: float) -> RoadNetwork:
    ids: list[str] = []
    make: dict[str, Callable[..., Any]] = {**_MADE, "connections": partial(_connection, ids)}
    found: dict[str, list[Any]] = {kind: [] for kind in make}
    for kind, rows in blocks:
        found[kind] += [make[kind](*row) for row in rows]
        ids += [row[0] for row in rows if kind == "lanes"]
    ((digest, (offset, projection), warnings, street_names),) = found["map"]
    return RoadNetwork(
        name=map_name(file),
        lanes={lane.id: lane for lane in found["lanes"]},
        connections=tuple(found["connections"]),
        junctions={junction.id: junction for junction in found["junctions"]},
        signals={signal.id: signal for signal in found["signals"]},
        frame=Frame((offset[0], offset[1]), projection),
        source=str(file),
        digest=digest,
        warnings=tuple(warnings),
        parts=dict(found["parts"]),
        segment_length=segment_length,
        street_names=street_names,
    )


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


def _connection(ids: Row, start: int, end: int, action: str, junction: str, path: Row, *others: Any) -> LaneConnection:
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


_MADE: dict[str, Callable[..., Any]] = {
    "map": lambda *row: row,
    "lanes": _lane,
    "junctions": _junction,
    "signals": _signal,
    "parts": lambda *row: row,
}
