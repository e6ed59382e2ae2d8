"""OpenDRIVE from strangers: CARLA's parser runs in a child process, since a damaged file may end the process."""

from __future__ import annotations

import importlib.util
import json
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.network import SEGMENT_LENGTH, RoadNetwork
from tmpud.roads.rows import from_rows
from tmpud.roads.xml_reading import shown

TIME_LIMIT = 300.0  # [s]
NO_CARLA = (
    "OpenDRIVE is read by CARLA's client, which is not installed: pip install 'tmpud[carla]'; or turn the file into a"
    " net: pip install 'tmpud[maps]', then tmpud map import"
)
_CHILD = "tmpud.roads.opendrive.child"


def has_carla() -> bool:
    """Whether CARLA's client is installed; it is not imported."""
    return importlib.util.find_spec("carla") is not None


def read_opendrive(path: Path, segment_length: float = SEGMENT_LENGTH) -> RoadNetwork:
    """Read an OpenDRIVE file as CARLA does. Raises MapError."""
    source = str(path) if str(path).isprintable() else shown(str(path))
    if not path.is_file():
        raise MapError(source, None, "cannot be read: not a file, or none that is there")
    if not has_carla():
        raise MapError(source, None, NO_CARLA)
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "network.json"
        _run(path, source, answer)
        found = json.loads(answer.read_bytes())
    if "error" in found:
        raise MapError(source, *found["error"])
    return from_rows(found["rows"], path, segment_length)


def _run(path: Path, source: str, answer: Path) -> None:
    """Let the child write its answer; MapError where it ends without one."""
    command = [sys.executable, "-P", "-m", _CHILD, str(path.absolute()), str(answer)]
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=TIME_LIMIT, check=False)  # noqa: S603
    except subprocess.TimeoutExpired as error:
        raise MapError(source, None, f"CARLA's parser did not end within {TIME_LIMIT:.0f} s") from error
    if done.returncode or not answer.is_file():
        raise MapError(source, None, _why(done.returncode, done.stderr))


def _why(code: int, said: bytes) -> str:
    """Return in one line how the child ended."""
    if code < 0:
        return f"CARLA's parser cannot read it: it ended with {signal.Signals(-code).name}"
    lines = said.decode(errors="replace").split("\n")
    last = next((line.strip() for line in reversed(lines) if line.strip()), "")
    return f"reading it failed: {last[:200] or f'exit code {code}'}"
