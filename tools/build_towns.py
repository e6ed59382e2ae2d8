"""Build the towns that ship with the package from their sources in ``tools/towns``, byte for byte the same each time.

    python tools/build_towns.py [--output FOLDER]

Needs netconvert, from the extra ``maps``.
"""

from __future__ import annotations

import argparse
import gzip
import re
import tempfile
from pathlib import Path

from tmpud.roads.sumo_tools import run_tool

TOOLS = Path(__file__).resolve().parent
SHIPPED = TOOLS.parent / "src" / "tmpud" / "roads" / "towns"
OPTIONS = {
    "no-turnarounds": "true",
    "rectangular-lane-cut": "true",
    "default.junctions.radius": "9",  # [m] stop lines well back, so that waiting and crossing cars do not touch
    "junctions.corner-detail": "8",
    "junctions.internal-link-detail": "10",
    "tls.cycle.time": "90",  # [s]
    "tls.yellow.time": "3",  # [s]
    "tls.allred.time": "7",  # [s] long enough for left-turning cars to leave the crossing
    "offset.disable-normalization": "true",
}


def build(source: Path, output: Path) -> Path:
    """Convert the plain XML files in a folder to ``<output>/<folder>.net.xml.gz`` and return its path."""
    with tempfile.TemporaryDirectory() as folder:
        net = Path(folder) / "town.net.xml"
        inputs = {f"{kind}-files": str(source / f"{source.name}.{suffix}.xml") for kind, suffix in _KINDS.items()}
        options = {**inputs, **OPTIONS, "output-file": str(net)}
        run_tool("netconvert", options)
        text = re.sub(r"<!-- generated on .*?-->\n*", "", net.read_text(encoding="utf-8"), flags=re.DOTALL)
    output.mkdir(parents=True, exist_ok=True)
    town = output / f"{source.name}.net.xml.gz"
    town.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))
    return town


_KINDS = {"node": "nod", "edge": "edg", "connection": "con"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=SHIPPED, help="folder for the nets")
    output = parser.parse_args().output
    for source in sorted(path for path in (TOOLS / "towns").iterdir() if path.is_dir()):
        print(build(source, output))


if __name__ == "__main__":
    main()
