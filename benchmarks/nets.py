"""Maps to measure on: shipped towns, net files, nets that come with SUMO, and grids that netgenerate draws."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from tmpud.roads.loading import map_file
from tmpud.roads.sumo_tools import run_tool

SHIPPED = "sumo:"  # nets that come with the Python package eclipse-sumo, by their path in its tools
_GRID = re.compile(r"grid:(\d+):(\d+)(:even)?")
BLOCK = 120  # [m]
SHIFT = "normc(0,15,-30,30)"  # [m] by which crossings are moved, so that ways differ in length


@contextmanager
def net_file(name: str) -> Iterator[Path]:
    """Give the net file of a town, of a path, or of ``grid:K:L``: K x K crossings, roads of L lanes each way.

    The blocks of ``grid:K:L:even`` are all alike, so that there are as many best ways as can be. ``sumo:game/DRT/osm``
    is a real net that comes with eclipse-sumo.
    """
    found = _GRID.fullmatch(name)
    if name.startswith(SHIPPED):
        yield Path(str(files("sumo"))) / "tools" / f"{name.removeprefix(SHIPPED)}.net.xml"
        return
    if not found:
        yield map_file(name)
        return
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"grid-{found[1]}-{found[2]}.net.xml"
        _netgenerate(file, crossings=found[1], lanes=found[2], even=bool(found[3]))
        yield file


def _netgenerate(file: Path, crossings: str, lanes: str, *, even: bool) -> None:
    """Draw a net without turning round, at one speed everywhere: the quickest way is the shortest one."""
    size = {"grid": "true", "grid.number": crossings, "default.lanenumber": lanes, "grid.length": str(BLOCK)}
    shape = {} if even else {"perturb-x": SHIFT, "perturb-y": SHIFT, "seed": "1"}
    ways = {"no-turnarounds": "true", "junctions.limit-turn-speed": "-1", "no-warnings": "true"}
    run_tool("netgenerate", {**size, **shape, **ways, "output-file": str(file)})
