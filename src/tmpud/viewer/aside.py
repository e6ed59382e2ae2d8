"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def written_aside(file: Path) -> Iterator[Path]:
    """Give the name of a file to write, which takes the place of ``file`` when all went well and else is removed.

    Folders that are missing are made. What goes wrong with the disk is an OSError that names ``file``.
    """
    draft = file.with_name(f".{os.getpid()}.part{file.suffix}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        yield draft
        draft.replace(file)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(file)) from error
    finally:
        draft.unlink(missing_ok=True)
