"""Run folders: an event log that is the same for the same seed, byte for byte, and what reads it back."""

from __future__ import annotations

import gzip
import json
import re
import zlib
from collections.abc import Iterator
from itertools import chain, islice
from pathlib import Path

from tmpud.errors import RequestError, RunFileError
from tmpud.events import Event, from_json, to_json
from tmpud.execution.timing import Stopwatch

LOG = "run.jsonl.gz"
TIMING = "timing.jsonl"
PICTURE = "map.png"
REPLAY = "replay.html"
COMPARISON = "compare.html"
NAME = re.compile(r"[a-z0-9][a-z0-9._-]{0,63}")


def run_name(words: str) -> str:
    """Return a name for a run folder that tells what words tell."""
    return re.sub("[^a-z0-9._]+", "-", words.lower())[-64:].lstrip("._-")


def record(events: Iterator[Event], folder: Path) -> Iterator[Event]:
    """Write every event into a run folder while passing it on; what was written stays if the run breaks off.

    Nothing is written, and no earlier run lost, where there is no first event. Raises RequestError for a folder that
    holds something else than a run.
    """
    if not NAME.fullmatch(folder.name):
        raise RequestError(f"{folder.name!r} is no name for a run: small letters, digits, '.', '_' and '-', at most 64")
    if folder.is_dir() and not (folder / LOG).exists() and any(folder.iterdir()):
        raise RequestError(f"{folder}: there are other files and no run; a new or empty folder is needed")
    first = list(islice(events, 1))
    folder.mkdir(parents=True, exist_ok=True)
    for stale in (TIMING, PICTURE, REPLAY, COMPARISON):  # of an earlier run: they do not belong to this log
        (folder / stale).unlink(missing_ok=True)
    with (folder / LOG).open("wb") as raw, gzip.GzipFile("", "wb", 6, raw, mtime=0) as log:
        for event in chain(first, events):
            log.write(_line(to_json(event)))
            yield event


def record_timing(stopwatch: Stopwatch, folder: Path) -> None:
    """Write the wall-clock latencies beside the event log."""
    rows = (_line({"kind": kind, "ms": round(ms, 3)}) for kind, ms in stopwatch.latencies)
    (folder / TIMING).write_bytes(b"".join(rows))


def read_run(folder: str | Path) -> Iterator[Event]:
    """Yield a run's events; RunFileError names the line that cannot be read."""
    path = Path(folder) / LOG
    read = 0  # lines
    try:
        with gzip.open(path, "rt", encoding="utf-8") as log:
            for line in log:
                event = from_json(json.loads(line))
                read += 1
                yield event
    except (FileNotFoundError, NotADirectoryError) as error:
        raise RunFileError(no_run(path)) from error
    except (OSError, EOFError, ValueError, zlib.error, RunFileError) as error:
        raise RunFileError(f"{path}:{read + 1}: {error}") from error
    if not read:
        raise RunFileError(f"{path}:1: the file is empty")


def no_run(path: Path) -> str:
    """Say that a log is not there, and how the folder is called where its log was named instead."""
    if path.parent.name == LOG and path.parent.is_file():
        return f"{path.parent}: a run is named by its folder, {path.parent.parent}"
    return f"{path}: no such run; a run folder holds {LOG}"


def _line(row: dict[str, object]) -> bytes:
    return (json.dumps(row, separators=(",", ":"), ensure_ascii=False, allow_nan=False) + "\n").encode()
