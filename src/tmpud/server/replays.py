"""Replays made from the log when they are asked for, each in a process of its own.

A log that takes long or much memory so never holds up the other pages, and Ctrl-C ends what is being made.
"""

from __future__ import annotations

import asyncio
import os
import resource
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from tmpud.errors import RunFileError, TmpudError
from tmpud.recording import LOG

KEPT = 8  # pages
LIMIT = 600.0  # [s] to make a page
MEMORY = 4 << 30  # bytes


@dataclass(frozen=True, slots=True)
class _Made:
    page: bytes
    stamp: tuple[int, int]  # of the log
    begun: float  # monotonic clock


class Replays:
    """The pages made last; one is made at a time, and all who asked before it was begun get the same."""

    def __init__(self) -> None:
        self._made: dict[Path, _Made] = {}
        self._making = asyncio.Lock()

    async def page(self, folder: Path) -> bytes:
        """Return the replay of a run folder; RunFileError where there is nothing to show."""
        asked = time.monotonic()
        async with self._making:
            stamp, known = _stamp(folder / LOG), self._made.pop(folder, None)
            if known is None or (known.stamp != stamp and known.begun < asked):
                begun = time.monotonic()
                known = _Made(await _make(folder), stamp, begun)
            self._made[folder] = known  # now the last
            while len(self._made) > KEPT:
                del self._made[next(iter(self._made))]
            return known.page


def _stamp(log: Path) -> tuple[int, int]:
    try:
        found = log.stat()
    except OSError as error:
        raise RunFileError(f"{log}: {error.strerror}") from error
    return found.st_size, found.st_mtime_ns


async def _make(folder: Path) -> bytes:
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", __name__, folder),
        stdin=asyncio.subprocess.DEVNULL, stdout=pipe, stderr=pipe, start_new_session=True,
    )  # fmt: skip
    try:
        page, said = await asyncio.wait_for(process.communicate(), LIMIT)
    except TimeoutError as error:
        raise RunFileError(f"{folder}: making its replay took more than {LIMIT:.0f} s") from error
    finally:
        with suppress(ProcessLookupError):
            process.kill()
    if process.returncode:
        last = said.decode(errors="replace").strip().rpartition("\n")[2]
        raise RunFileError(f"its replay cannot be made: {last or 'too little memory'}")
    return page


def main() -> None:
    """Write the replay of the run folder that is named to stdout."""
    from tmpud.viewer.document import replay_document
    from tmpud.viewer.intact import read_intact
    from tmpud.viewer.replay import render

    os.nice(10)  # what is being run goes first
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    try:
        page = render(replay_document(read_intact(Path(sys.argv[1]))))
    except TmpudError as error:
        sys.exit(str(error))
    sys.stdout.buffer.write(page.encode())


if __name__ == "__main__":
    main()
