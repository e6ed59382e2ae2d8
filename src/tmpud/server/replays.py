"""Replays made from the log when they are asked for, each in a process of its own."""

from __future__ import annotations

import sys
from collections.abc import Hashable
from pathlib import Path

from tmpud.errors import RunFileError, TmpudError
from tmpud.recording import LOG
from tmpud.server import children
from tmpud.server.kept import Kept

KEPT = 8  # pages


def replays() -> Kept[bytes]:
    """Return what makes the replays of run folders; RunFileError where there is nothing to show."""
    return Kept(KEPT, lambda folder: _make(folder), _stamp)


def _stamp(folder: Path) -> Hashable:
    return children.stamp(folder / LOG)


async def _make(folder: Path) -> bytes:
    try:
        return await children.said_by(__name__, folder)
    except RunFileError as error:
        raise RunFileError(f"its replay cannot be made: {error}") from error


def main() -> None:
    """Write the replay of the run folder that is named to stdout."""
    from tmpud.viewer.document import replay_document
    from tmpud.viewer.intact import read_intact
    from tmpud.viewer.replay import render

    (folder,) = children.begin()
    try:
        page = render(replay_document(read_intact(Path(folder))))
    except TmpudError as error:
        sys.exit(str(error))
    sys.stdout.buffer.write(page.encode())


if __name__ == "__main__":
    main()
