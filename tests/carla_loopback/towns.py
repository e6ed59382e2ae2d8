"""Towns for the loopback server: SUMO nets, written as OpenDRIVE by netconvert."""

from __future__ import annotations

from pathlib import Path

from tests.carla_loopback.maps import LIGHT
from tmpud.roads.sumo_tools import run_tool

NETCONVERTS_LIGHT = "1000011"  # the type it writes, of which CARLA's client knows nothing


def as_opendrive(net: Path, folder: Path) -> Path:
    """Return a net as an OpenDRIVE file in the same coordinates, named as CARLA's server would name it."""
    xodr = folder / f"{net.name.split('.')[0]}.xodr"
    run_tool("netconvert", {"sumo-net-file": str(net), "opendrive-output": str(xodr)})
    text = xodr.read_text(encoding="utf-8").replace(f'type="{NETCONVERTS_LIGHT}"', f'type="{LIGHT}"')
    xodr.write_text(text, encoding="utf-8")
    return xodr
