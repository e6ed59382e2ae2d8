"""Towns for the loopback server: SUMO nets, written as OpenDRIVE by netconvert."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from tests.carla_loopback.maps import LIGHT
from tests.simulators.nets import netconvert

NETCONVERTS_LIGHT = "1000011"  # the type it writes, of which CARLA's client knows nothing


def as_opendrive(net: Path, folder: Path) -> Path:
    """Return a net as an OpenDRIVE file in the same coordinates, named as CARLA's server would name it."""
    xodr = folder / f"{net.name.split('.')[0]}.xodr"
    command = [netconvert(), "--sumo-net-file", str(net), "--opendrive-output", str(xodr)]
    environment = {key: value for key, value in os.environ.items() if value or key != "SUMO_HOME"}
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment)
    text = xodr.read_text(encoding="utf-8").replace(f'type="{NETCONVERTS_LIGHT}"', f'type="{LIGHT}"')
    xodr.write_text(text, encoding="utf-8")
    return xodr
