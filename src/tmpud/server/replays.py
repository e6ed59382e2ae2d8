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

Folders = tuple[Path, ...]  # of one run, or of two to be compared


def replays() -> Kept[Folders, bytes]:
    """Return what makes the replays of run folders; RunFileError where there is nothing to show."""
    return Kept(KEPT, lambda folders: _make(folders), _stamp)


def _stamp(folders: Folders) -> Hashable:
    return children.stamp(*(folder / LOG for folder in folders))


async def _make(folders: Folders) -> bytes:
    try:
        return await children.said_by(__name__, *folders)
    except RunFileError as error:
        raise RunFileError(f"its replay cannot be made: {error}") from error


def main() -> None:
    """Write the replay of the run folder that is named, or of two, to stdout."""
    from tmpud.viewer.comparison import comparison_document
    from tmpud.viewer.document import replay_document
    from tmpud.viewer.intact import read_intact
    from tmpud.viewer.replay import render

    folders = children.begin()
    try:
        runs = [read_intact(Path(folder)) for folder in folders]
        page = render(replay_document(*runs) if len(runs) == 1 else comparison_document(*runs))
    except TmpudError as error:
        sys.exit(str(error))
    sys.stdout.buffer.write(page.encode())


if __name__ == "__main__":
    main()
