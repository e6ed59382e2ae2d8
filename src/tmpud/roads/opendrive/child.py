"""The child process in which a file is read: ``python -m tmpud.roads.opendrive.child FILE ANSWER``."""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.opendrive.town import read_town
from tmpud.roads.rows import to_rows

MEMORY = 8 << 30  # [bytes] of address space; what needs more is no map


def main(file: str, answer: str) -> None:
    """Write the network, or why there is none, as JSON."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        found: dict[str, object] = {"rows": [*to_rows(read_town(Path(file)))]}
    except MapError as error:
        found = {"error": [error.line, error.cause]}
    Path(answer).write_text(json.dumps(found, allow_nan=False), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
