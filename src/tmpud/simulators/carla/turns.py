"""One client of ours at a time on a server: a second one would load its map under the first."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import IO
from urllib.parse import quote

from tmpud.errors import SimulatorError
from tmpud.locks import HeldError, held

TIDIED = 10.0  # [s] in which a client whose drive was killed is done with tidying up


def turn(host: str, port: int, patience: float = TIDIED) -> IO[str]:
    """Return the lock on a server, to be kept open while it is used; SimulatorError where another process uses it."""
    folder = Path(tempfile.gettempdir()) / f"tmpud-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    try:
        return held(folder / f"{quote(host, safe='')}-{port}.lock", patience)
    except HeldError as owner:
        raise SimulatorError(f"in use by tmpud's process {owner}: wait until it is done, or end it") from owner
