"""OpenDRIVE turned into a SUMO net by SUMO's own converter, which comes with the extra ``maps``."""

from __future__ import annotations

import gzip
import importlib.util
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive.facts import read_facts
from tmpud.roads.sumo_net import read_sumo_net

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
    command = [_binary(), *(f"--{name}={value}" for name, value in options.items())]
    try:
        done = subprocess.run(  # noqa: S603
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=TIME_LIMIT,
            check=False,
            env={name: value for name, value in os.environ.items() if value or name != "SUMO_HOME"},
        )
    except subprocess.TimeoutExpired as error:
        raise MapError(str(source), None, f"netconvert did not end within {TIME_LIMIT:.0f} s") from error
    if done.returncode or not written.is_file():
        raise MapError(str(source), None, f"netconvert cannot read it: {_why(done.returncode, done.stderr)}")


def _binary() -> str:
    """Return netconvert's path: of this Python's ``eclipse-sumo``, else the system's."""
    beside = Path(sys.executable).parent / "netconvert"
    spec = importlib.util.find_spec("sumo")
    folders = (spec.submodule_search_locations if spec else None) or ()
    for place in (beside, *(Path(folder) / "bin" / "netconvert" for folder in folders)):
        if place.is_file():
            return str(place)
    if found := shutil.which("netconvert"):
        return found
    raise MapError("netconvert", None, "is not installed: pip install 'tmpud[maps]'")


def _why(code: int, said: bytes) -> str:
    """Return in one line how netconvert ended."""
    if code < 0:
        return f"it ended with {signal.Signals(-code).name}"
    lines = [line.strip() for line in said.decode(errors="replace").split("\n")]
    first = next((line.removeprefix("Error:").strip() for line in lines if line.startswith("Error")), "")
    return first[:200] or f"it ended with exit code {code}"
