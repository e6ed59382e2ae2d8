"""The two ends of a run's log, read on from where it was while the log grows."""

from __future__ import annotations

import os
import time
import zlib
from pathlib import Path
from typing import BinaryIO

from tmpud.events import Event
from tmpud.viewer.intact import read_event

BLOCK = 1 << 16  # bytes of the file read at a time
HEAD = 4096  # bytes by which runs are told apart
LONGEST = 1 << 24  # bytes of a line


class Log:
    """A gzipped log of which the first and the last whole line are known, and how many lines there are."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._begin()

    def _begin(self) -> None:
        self.first: Event | None = None
        self.last: Event | None = None
        self.lines = 0
        self.damage = ""
        self._at = 0  # bytes of the file read
        self._stamp = (0, 0)  # inode, time of change
        self._head = b""  # the first bytes, as far as they were there when it was first read
        self._rest = b""  # of a line that has no end yet
        self._packed = zlib.decompressobj(wbits=31)

    def read_on(self, until: float) -> bool:
        """Read what is new; return whether the end was reached before the monotonic clock was at ``until``."""
        with self._file.open("rb") as file:
            if self._is_another(file):
                self._begin()
            found = os.fstat(file.fileno())
            self._stamp = (found.st_ino, found.st_mtime_ns)
            file.seek(self._at)
            while not self.damage and (block := file.read(BLOCK)):
                self._head = self._head or block[:HEAD]
                self._at += len(block)
                self._take(block)
                if time.monotonic() > until:
                    return False
        return True

    def _is_another(self, file: BinaryIO) -> bool:
        """Whether another run was written in this one's place, perhaps a longer one."""
        found, head = os.fstat(file.fileno()), file.read(HEAD)
        over = (self._packed.eof or self.damage) and found.st_mtime_ns != self._stamp[1]
        return (
            found.st_size < self._at or found.st_ino != self._stamp[0] or not head.startswith(self._head) or bool(over)
        )

    def _take(self, block: bytes) -> None:
        try:
            text = self._rest + self._packed.decompress(block)
        except zlib.error as error:
            self.damage = f"everything after line {self.lines} ({error})"
            return
        *whole, self._rest = text.split(b"\n")
        if len(self._rest) > LONGEST:
            self.damage = f"line {self.lines + len(whole) + 1}: longer than {LONGEST:,} bytes"
        if whole:
            if not self.lines:
                self.first = _event(whole[0])
            self.last = _event(whole[-1])
            self.lines += len(whole)


def _event(line: bytes) -> Event | None:
    return read_event(line.decode(errors="replace"))
