"""What there is to show: found by looking through folders. A URL names an entry by its number here, never a path."""

from __future__ import annotations

import hashlib
import os
import stat
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tmpud import recording
from tmpud.errors import RunFileError
from tmpud.experiments.running import manifest, store

RUN, EXPERIMENT = "runs", "experiments"
DEPTH = 6  # of folders below the one that is shown
MOST = 20_000  # folders looked through
KEPT = 1.0  # [s] after which is looked again


@dataclass(frozen=True, slots=True)
class Entry:
    """A folder that holds a run or an experiment."""

    kind: str
    id: str  # the same at each look
    name: str  # for people; may hold anything
    folder: Path


class Index:
    """The runs and experiments below some folders, as they were a second ago at the latest."""

    def __init__(self, roots: Sequence[Path]) -> None:
        self._roots = [root.resolve() for root in roots]
        self._lock = threading.Lock()
        self._entries: dict[tuple[str, str], Entry] = {}
        self._until = 0.0

    def entries(self) -> list[Entry]:
        with self._lock:
            if time.monotonic() >= self._until:
                found = (entry for root in self._roots for entry in _scan(root))
                self._entries = {(entry.kind, entry.id): entry for entry in found}
                self._until = time.monotonic() + KEPT
            return list(self._entries.values())

    def get(self, kind: str, name: str) -> Entry | None:
        """Return the entry of this id, if its folder is still what it was taken for."""
        self.entries()
        entry = self._entries.get((kind, name))
        return entry if entry and entry.folder.resolve() == entry.folder and kind in _kinds(entry.folder) else None


def _scan(root: Path) -> Iterator[Entry]:
    """Yield what lies in a folder and below it; links are not followed."""
    for number, (place, below, _) in enumerate(os.walk(root)):
        folder = Path(place)
        depth = len(folder.relative_to(root).parts)
        below[:] = sorted(name for name in below if not name.startswith(".")) if depth < DEPTH else []
        name = folder.relative_to(root.parent).as_posix().encode(errors="replace").decode()
        for kind in _kinds(folder):
            yield Entry(kind, hashlib.sha256(os.fsencode(folder)).hexdigest()[:16], name, folder)
        if number >= MOST:
            return


def _kinds(folder: Path) -> Iterator[str]:
    if is_file(folder / recording.LOG):
        yield RUN
    described = folder / manifest.MANIFEST
    if is_file(folder / store.RESULTS) and (is_file(described) or not os.path.lexists(described)):
        yield EXPERIMENT


def is_file(path: Path) -> bool:
    """Whether there is a file itself: no link, from which a file elsewhere would be read, and no pipe."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False


def read_file(path: Path, most: int) -> bytes:
    """Return what is in a file of at most ``most`` bytes; RunFileError where it is none, or larger."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        raise RunFileError(f"{path.name} cannot be read: {error.strerror}") from error
    with os.fdopen(descriptor, "rb") as file:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode) or len(data := file.read(most + 1)) > most:
            raise RunFileError(f"{path.name} cannot be shown: it is no file, or larger than {most:,} bytes")
        return data
