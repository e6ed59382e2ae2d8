"""SUMO's own programs, which come with the extra ``maps``: where they are, and how they are run."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from tmpud.errors import MapError


def run_tool(
    name: str, options: Mapping[str, str], *, timeout: float | None = None, check: bool = True
) -> subprocess.CompletedProcess[bytes]:
    """Run ``netconvert``, ``netgenerate``, ... with some options.

    Raises MapError where it is not installed or, with ``check``, fails, and TimeoutExpired after ``timeout`` seconds.
    """
    command = [_binary(name), *(f"--{option}={value}" for option, value in options.items())]
    # an empty SUMO_HOME is none, but SUMO's programs do not survive it
    environment = {key: value for key, value in os.environ.items() if value or key != "SUMO_HOME"}
    done = subprocess.run(  # noqa: S603
        command, stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout, check=False, env=environment
    )
    if check and done.returncode:
        said = done.stderr.decode(errors="replace").strip().rpartition("\n")[2]
        raise MapError(name, None, f"failed with exit code {done.returncode}: {said}")
    return done


def _binary(name: str) -> str:
    """Return a program's path: of this Python's ``eclipse-sumo``, else the system's."""
    spec = importlib.util.find_spec("sumo")
    folders = (spec.submodule_search_locations if spec else None) or ()
    for place in (Path(sys.executable).parent / name, *(Path(folder) / "bin" / name for folder in folders)):
        if place.is_file():
            return str(place)
    if found := shutil.which(name):
        return found
    raise MapError(name, None, "is not installed: pip install 'tmpud[maps]'")
