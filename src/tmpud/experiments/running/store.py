"""A folder that loses no result: whatever was returned from ``append`` is there after any kill."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Self

from tmpud.errors import FolderError
from tmpud.experiments.running import lines
from tmpud.experiments.running.manifest import Experiment, claim, describe, read_manifest, sync_folder
from tmpud.experiments.running.tasks import DONE, Json, Record, Task, results_hash
from tmpud.locks import HeldError, held

RESULTS = "results.jsonl"
TIMING = "timing.jsonl"  # wall-clock times, in no hash
LOG = "workers.log"  # what workers print, and tracebacks
LOCK = "lock"
PATIENCE = 1.0  # [s] to wait for the lock: a process just started by a killed owner holds it for a moment


@dataclass(frozen=True, slots=True)
class Results:
    """What a results folder holds."""

    manifest: dict[str, Any]
    records: tuple[Record, ...]  # one a task, in the order in which tasks first ended
    damages: tuple[str, ...]  # "file:line: what" of each line that does not count

    @property
    def complete(self) -> bool:
        return len(self.records) == int(self.manifest["tasks"]["count"])


def read_results(folder: Path) -> Results:
    """Read a results folder, also while it grows; RunFileError where there is none."""
    manifest, file = read_manifest(folder), folder / RESULTS
    with _named(file):
        contents = lines.read(file)
    records, refused = lines.counted(file, contents)
    return Results(manifest, tuple(records.values()), (*contents.damages, *refused))


def provenance(results: Results) -> dict[str, str]:
    """Return what a report says of what was run."""
    manifest = results.manifest
    tasks, ended = manifest["tasks"], Counter(record.status for record in results.records)
    counts = f"{ended.pop(DONE, 0)} of {tasks['count']} done" + "".join(
        f", {n} {name}" for name, n in sorted(ended.items())
    )
    return {
        "begun": manifest["begun"],
        **{name: _said(value) for name, value in manifest["options"].items()},
        "versions": ", ".join(f"{name} {version}" for name, version in manifest["versions"].items()),
        "code": manifest["code"],
        "tasks": f"{counts} (digest {tasks['digest']})",
        "results": results_hash(results.records),
    }


def _said(value: Any) -> str:
    """Return an option as text; whole numbers that follow one another as "first..last"."""
    if not isinstance(value, list):
        return str(value)
    first = value[0] if value else None
    if isinstance(first, int) and len(value) > 2 and value == list(range(first, first + len(value))):
        return f"{value[0]}..{value[-1]}"
    return ", ".join(map(str, value))


class Store:
    """An experiment's folder, open for more results; only one can be open at a time."""

    def __init__(self, folder: Path, experiment: Experiment, tasks: Sequence[Task]) -> None:
        """Take over the folder; FolderError where it is another's, in use, or cannot be written."""
        self._results = folder / RESULTS
        self._open_files = ExitStack()
        with _named(folder):
            folder.mkdir(parents=True, exist_ok=True)
            self._open_files.enter_context(_locked(folder / LOCK))
        try:
            with _named(folder):
                self._open(folder, describe(experiment, tasks), {task.key: task.digest for task in tasks})
        except BaseException:
            self.close()
            raise

    def _open(self, folder: Path, manifest: Json, digests: dict[str, str]) -> None:
        if self._results.exists():
            read_manifest(folder)  # without one, nobody knows whose they are
        claim(folder, manifest)
        contents = lines.read(self._results)
        self.records, refused = lines.counted(self._results, contents, digests)
        self.damages = (*contents.damages, *refused)
        self._descriptor = os.open(self._results, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
        self._open_files.callback(os.close, self._descriptor)
        self._size = contents.size
        os.ftruncate(self._descriptor, self._size)  # a line that was cut off would spoil the next
        os.fsync(self._descriptor)
        sync_folder(folder)
        self.log = self._open_files.enter_context((folder / LOG).open("ab"))
        self._timing = self._open_files.enter_context((folder / TIMING).open("a", encoding="utf-8"))

    def append(self, records: Iterable[Record]) -> None:
        """Write records such that they outlast a kill and a loss of power; all or, with FolderError, none."""
        data = b"".join(map(lines.encode, records))
        try:
            _write(self._descriptor, data)
            os.fsync(self._descriptor)
        except OSError as error:
            with suppress(OSError):
                os.ftruncate(self._descriptor, self._size)
            raise FolderError(
                f"{self._results}: cannot be written ({error.strerror}); the results before are kept"
            ) from error
        self._size += len(data)

    def note(self, timings: Iterable[Json]) -> None:
        """Keep wall-clock times beside the results."""
        with _named(Path(self._timing.name)):
            self._timing.writelines(json.dumps(row) + "\n" for row in timings)
            self._timing.flush()

    def close(self) -> None:
        """Let others have the folder."""
        with suppress(OSError):  # what cannot be written was said before
            self._open_files.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _write(descriptor: int, data: bytes) -> None:
    left = memoryview(data)
    while left:
        left = left[os.write(descriptor, left) :]


def _locked(file: Path) -> IO[str]:
    try:
        return held(file, PATIENCE)
    except HeldError as owner:
        raise FolderError(
            f"{file.parent}: in use by process {owner}; wait until it is done, or choose another folder"
        ) from owner


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Turn what the system refuses into one line that names the file."""
    try:
        yield
    except OSError as error:
        raise FolderError(f"{error.filename or path}: {error.strerror or error}") from error
