"""OpenDRIVE turned into a SUMO net by SUMO's own converter, which comes with the extra ``maps``."""

from __future__ import annotations

import gzip
import re
import signal
import subprocess
import tempfile
from dataclasses import replace
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive.facts import read_facts
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.roads.sumo_tools import run_tool

OPTIONS = {
    "offset.disable-normalization": "true",  # the map's own coordinates, which are CARLA's but for the sign of y
    "opendrive.internal-shapes": "true",
    "opendrive.curve-resolution": "1",  # [m]
    "opendrive.ignore-misplaced-signals": "true",  # otherwise there are lights where no lane has one
    "geometry.remove": "true",  # joins what is cut into sections, without which lanes are too short to merge
    "no-turnarounds": "true",
}
TIME_LIMIT = 600.0  # [s]


def import_net(source: Path, net: Path) -> RoadNetwork:
    """Write an OpenDRIVE file as ``.net.xml`` or ``.net.xml.gz``, and return what it has; MapError if that fails.

    A file that is there already is replaced by a whole new one or not at all.
    """
    read_facts(source)
    net.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=net.parent, prefix=".") as folder:
        written = Path(folder) / "made.net.xml"
        _convert(source, written)
        text = re.sub(r"<!-- generated on .*?-->\n*", "", written.read_text(encoding="utf-8"), flags=re.DOTALL)
        made = Path(folder) / net.name
        made.write_bytes(gzip.compress(text.encode(), mtime=0) if net.suffix == ".gz" else text.encode())
        try:
            network = read_sumo_net(made)
        except MapError as error:
            raise MapError(str(source), None, f"netconvert makes no sound net of it: {error.cause}") from error
        made.replace(net)
    return replace(network, source=str(net))


def _convert(source: Path, written: Path) -> None:
    options = {"opendrive-files": str(source.absolute()), "output-file": str(written), **OPTIONS}
    try:
        done = run_tool("netconvert", options, timeout=TIME_LIMIT, check=False)
    except subprocess.TimeoutExpired as error:
        raise MapError(str(source), None, f"netconvert did not end within {TIME_LIMIT:.0f} s") from error
    if done.returncode or not written.is_file():
        raise MapError(str(source), None, f"netconvert cannot read it: {_why(done.returncode, done.stderr)}")


def _why(code: int, said: bytes) -> str:
    """Return in one line how netconvert ended."""
    if code < 0:
        return f"it ended with {signal.Signals(-code).name}"
    lines = [line.strip() for line in said.decode(errors="replace").split("\n")]
    first = next((line.removeprefix("Error:").strip() for line in lines if line.startswith("Error")), "")
    return first[:200] or f"it ended with exit code {code}"
