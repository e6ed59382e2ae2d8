from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.roads.nets import CROSSING
from tmpud.errors import MapError
from tmpud.roads import load_map, shipped_towns


def test_a_map_is_a_shipped_town_or_a_file(tmp_path: Path) -> None:
    path = tmp_path / "crossing.net.xml"
    path.write_text(CROSSING)
    assert load_map(path).name == "crossing"
    assert load_map("millbrook").name == "millbrook"
    assert "millbrook" in shipped_towns()


@pytest.mark.parametrize("name", ["milbrook", "town.osm", "", "a\nb"])
def test_an_unknown_town_is_refused_with_the_towns_there_are(name: str) -> None:
    with pytest.raises(MapError, match="millbrook") as caught:
        load_map(name)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "name", ["missing.net.xml", ".net.xml", "a\0b.net.xml", "a\nb.net.xml", "pipe.net.xml", "x.net.xml", "a\nb.xodr"]
)
def test_a_file_that_cannot_be_read_is_one_line(name: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.net.xml")  # must not wait for someone to write into it
    (tmp_path / "x.net.xml").mkdir()
    with pytest.raises(MapError, match="cannot be read") as caught:
        load_map(tmp_path / name)
    assert "\n" not in str(caught.value)


def test_reading_a_map_loads_neither_numpy_nor_a_simulator() -> None:
    code = "import sys, tmpud.roads as r; r.load_map('millbrook'); print({'numpy', 'libsumo'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
