"""Maps of a CARLA server, as files."""

from __future__ import annotations

import contextlib
import tempfile
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.cache import cache_folder
from tmpud.roads.loading import map_file
from tmpud.simulators.carla.session import Address, Session


def fetch(server: Address, name: str) -> str:
    """Return the file of a map: a local map's name or file as it is, or what the server has by that name.

    Raises SimulatorError where it has none.
    """
    with contextlib.suppress(MapError):
        map_file(name)
        return name
    with contextlib.closing(Session(server)) as session:
        text: str = session.load("map", name=name).words["xodr"]
    file = (cache_folder() or Path(tempfile.gettempdir())) / "carla" / f"{name.rsplit('/', 1)[-1]}.xodr"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")
    return str(file)
