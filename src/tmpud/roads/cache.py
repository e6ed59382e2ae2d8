"""Large maps that were read before, kept in the user's cache folder by content, so that reading them again is quick.

A file of the cache is lines of JSON: what it was made from and by which code; the network, some rows at a time; a
digest of all that. A line stays as it is until what it holds is asked for. A file that is damaged, or another
version's, is as good as none. ``TMPUD_NO_CACHE=1`` keeps none.
"""

from __future__ import annotations

import gc
import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from itertools import chain
from pathlib import Path
from typing import BinaryIO

from tmpud.roads.network import RoadNetwork
from tmpud.roads.rows import from_rows, to_rows

LARGE = 2_000  # [lanes] smaller maps are read as quickly as a cache would be
_CODE = Path(__file__).parent
_END = "end"


def cache_folder(of: str = "maps") -> Path | None:
    """Return where maps, or other things, are kept; None where the user wants none kept or has no home."""
    if os.environ.get("TMPUD_NO_CACHE"):
        return None
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tmpud" / of
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
        with place.open("rb") as lines, _no_collection():
            return from_rows(_blocks(lines, place.stem), file, segment_length)
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
    with suppress(OSError):  # the next time it is read from the net itself
        place.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=place.parent, prefix=".") as folder:
            written = Path(folder) / place.name
            with written.open("wb") as file:
                digest = hashlib.sha256()
                for block in chain([_stamp(place.stem)], to_rows(network)):
                    line = json.dumps(block, separators=(",", ":"), allow_nan=False).encode() + b"\n"
                    digest.update(line)
                    file.write(line)
                file.write(json.dumps([_END, digest.hexdigest()]).encode() + b"\n")
            written.replace(place)


def _blocks(lines: BinaryIO, map_digest: str) -> Iterator[tuple[str, bytes]]:
    """Yield the lines of a file of the cache under the names of their kinds; ValueError where it is not whole."""
    stamp = lines.readline()
    if json.loads(stamp) != _stamp(map_digest):
        raise ValueError("made from another map, or by other code")
    digest = hashlib.sha256(stamp)
    for line in lines:
        kind = line[2 : line.index(b'"', 2)].decode()  # of ["kind",[...]]
        if kind == _END:
            if json.loads(line) != [_END, digest.hexdigest()] or lines.read(1):
                raise ValueError("not what was written")
            return
        digest.update(line)
        yield kind, line
    raise ValueError("cut short")


def _stamp(map_digest: str) -> dict[str, str]:
    return {"map": map_digest, "code": _code_digest()}


@cache
def _code_digest() -> str:
    """Return what changes with the code that reads maps."""
    files = [*sorted(_CODE.rglob("*.py")), _CODE.parent / "geometry.py", _CODE.parent / "symbols.py"]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()
