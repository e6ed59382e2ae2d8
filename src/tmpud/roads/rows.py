"""A road network in the types of JSON, and back: how it is cached, and how a child process hands it over."""

from __future__ import annotations

import math
from dataclasses import fields
from pathlib import Path
from typing import Any

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import WHOLE, Frame, Junction, Lane, LaneConnection, RoadNetwork, SignalProgram, Stretch
from tmpud.symbols import Action

Row = list[Any]


def map_name(path: Path) -> str:
    """Return what a map from a file is called."""
    return path.name.removesuffix(".gz").removesuffix(".xml").removesuffix(".net").removesuffix(".xodr")


def to_rows(network: RoadNetwork) -> dict[str, Any]:
    """Return a network in the types of JSON; connections name lanes by their number."""
    number = {lane: i for i, lane in enumerate(network.lanes)}
    return {
        "digest": network.digest,
        "lanes": [
            _values(
                lane,
                centre=lane.centre.points,
                change_left=_finite(lane.change_left),
                change_right=_finite(lane.change_right),
            )
            for lane in network.lanes.values()
        ],
        "connections": [
            _values(each, from_lane=number[each.from_lane], to_lane=number[each.to_lane], path=each.path.points)
            for each in network.connections
        ],
        "junctions": [_values(junction) for junction in network.junctions.values()],
        "signals": [_values(signal) for signal in network.signals.values()],
        "frame": _values(network.frame),
        "warnings": network.warnings,
        "parts": network.parts,
    }


def _finite(stretches: tuple[Stretch, ...]) -> Row | None:
    """Return stretches with None for the end of any lane, as JSON has no infinity, and for the whole of one."""
    if stretches == WHOLE:
        return None
    return [(start, None if math.isinf(end) else end) for start, end in stretches]


def _values(item: Any, **instead: Any) -> Row:
    return [instead.get(field.name, getattr(item, field.name)) for field in fields(item)]


def from_rows(rows: dict[str, Any], file: Path, segment_length: float) -> RoadNetwork:
    lanes = [_lane(*row) for row in rows["lanes"]]
    ids = [lane.id for lane in lanes]
    return RoadNetwork(
        name=map_name(file),
        lanes={lane.id: lane for lane in lanes},
        connections=tuple(_connection(ids, *row) for row in rows["connections"]),
        junctions={row[0]: _junction(*row) for row in rows["junctions"]},
        signals={row[0]: _signal(*row) for row in rows["signals"]},
        frame=Frame((rows["frame"][0][0], rows["frame"][0][1]), rows["frame"][1]),
        source=str(file),
        digest=rows["digest"],
        warnings=tuple(rows["warnings"]),
        parts=rows["parts"],
        segment_length=segment_length,
    )


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
