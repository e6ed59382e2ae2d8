"""Large maps that were read before, kept in the user's cache folder by content, so that reading them again is quick.

A file of the cache is a line of JSON, which says what it was made from and by which code, and a line with the network.
One that is damaged, or another version's, is as good as none. ``TMPUD_NO_CACHE=1`` keeps none.
"""

from __future__ import annotations

import gc
import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import fields
from functools import cache
from pathlib import Path
from typing import Any

from tmpud.geometry import Point, Polyline
from tmpud.roads.network import Frame, Junction, Lane, LaneConnection, RoadNetwork, SignalProgram
from tmpud.roads.sumo_net import net_name
from tmpud.symbols import Action

LARGE = 2_000  # [lanes] smaller maps are read as quickly as a cache would be
_CODE = Path(__file__).parent

Row = list[Any]


def cache_folder() -> Path | None:
    """Return where maps are kept, None where the user wants none or has no home."""
    if os.environ.get("TMPUD_NO_CACHE"):
        return None
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tmpud" / "maps"
    except RuntimeError:
        return None


def read_cached(
    file: Path, segment_length: float, read: Callable[[Path], RoadNetwork], folder: Path | None, large: int = LARGE
) -> RoadNetwork:
    """Return the network of a file, from the cache folder where it is kept there; a large one is kept from now on.

    ``read`` reads the file itself, into segments of the same length. Raises what it raises.
    """
    if folder is None or not file.is_file():
        return read(file)
    try:
        with file.open("rb") as opened:
            digest = hashlib.file_digest(opened, "sha256").hexdigest()
    except OSError:
        return read(file)  # which says why it cannot be read
    place = folder / f"{digest}.json"
    if (kept := _kept(place, file, segment_length)) is not None:
        return kept
    network = read(file)
    if len(network.lanes) >= large and network.digest == digest:
        _keep(place, network)
    return network


def _kept(place: Path, file: Path, segment_length: float) -> RoadNetwork | None:
    """Return the network that a file of the cache holds, None where it holds none that can be used."""
    try:
        stamp, _, body = place.read_bytes().partition(b"\n")
        if json.loads(stamp) != _stamp(place.stem, body):
            return None
        with _no_collection():
            return _network(json.loads(body), file, segment_length)
    except (OSError, ValueError, TypeError, LookupError, RecursionError):
        return None


@contextmanager
def _no_collection() -> Iterator[None]:
    """Keep Python from looking for garbage, of which making very many objects leaves none: it takes half the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _keep(place: Path, network: RoadNetwork) -> None:
    """Write a network into the cache, whole or not at all."""
    body = json.dumps(_rows(network), separators=(",", ":"), allow_nan=False).encode()
    with suppress(OSError):  # the next time it is read from the net itself
        place.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=place.parent, prefix=".") as folder:
            written = Path(folder) / place.name
            written.write_bytes(json.dumps(_stamp(place.stem, body)).encode() + b"\n" + body)
            written.replace(place)


def _stamp(digest: str, body: bytes) -> dict[str, str]:
    return {"map": digest, "code": _code_digest(), "body": hashlib.sha256(body).hexdigest()}


@cache
def _code_digest() -> str:
    """Return what changes with the code that reads maps."""
    files = [*sorted(_CODE.glob("*.py")), _CODE.parent / "geometry.py"]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def _rows(network: RoadNetwork) -> dict[str, Any]:
    """Return a network in the types of JSON; connections name lanes by their number."""
    number = {lane: i for i, lane in enumerate(network.lanes)}
    return {
        "digest": network.digest,
        "lanes": [_values(lane, centre=lane.centre.points) for lane in network.lanes.values()],
        "connections": [
            _values(each, from_lane=number[each.from_lane], to_lane=number[each.to_lane], path=each.path.points)
            for each in network.connections
        ],
        "junctions": [_values(junction) for junction in network.junctions.values()],
        "signals": [_values(signal) for signal in network.signals.values()],
        "frame": _values(network.frame),
        "warnings": network.warnings,
    }


def _values(item: Any, **instead: Any) -> Row:
    return [instead.get(field.name, getattr(item, field.name)) for field in fields(item)]


def _network(rows: dict[str, Any], file: Path, segment_length: float) -> RoadNetwork:
    lanes = [_lane(*row) for row in rows["lanes"]]
    ids = [lane.id for lane in lanes]
    return RoadNetwork(
        name=net_name(file),
        lanes={lane.id: lane for lane in lanes},
        connections=tuple(_connection(ids, *row) for row in rows["connections"]),
        junctions={row[0]: _junction(*row) for row in rows["junctions"]},
        signals={name: _signal(name, offset, phases) for name, offset, phases in rows["signals"]},
        frame=Frame((rows["frame"][0][0], rows["frame"][0][1]), rows["frame"][1]),
        source=str(file),
        digest=rows["digest"],
        warnings=tuple(rows["warnings"]),
        segment_length=segment_length,
    )


def _lane(name: str, edge: str, index: int, centre: Row, elevation: Row, *others: Any) -> Lane:
    return Lane(name, edge, index, Polyline(centre), tuple(elevation), *others)


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


def _signal(name: str, offset: float, phases: Row) -> SignalProgram:
    return SignalProgram(name, offset, tuple((duration, state) for duration, state in phases))


def _points(row: Row) -> tuple[Point, ...]:
    return tuple((x, y) for x, y in row)
