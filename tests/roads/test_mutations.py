from __future__ import annotations

import gzip
from pathlib import Path

from tests.roads.mutations import fuzz
from tests.roads.nets import CROSSING
from tmpud.roads.loading import map_file


def test_a_damaged_crossing_is_refused_in_one_line_or_sound(tmp_path: Path) -> None:
    outcomes = fuzz(CROSSING.encode(), 300, 1, tmp_path)
    assert outcomes["refused"] > 100
    assert outcomes["valid"] > 20


def test_a_damaged_town_is_refused_in_one_line_or_sound(tmp_path: Path) -> None:
    assert fuzz(gzip.decompress(map_file("millbrook").read_bytes()), 40, 2, tmp_path).total() == 40


def test_a_damaged_carla_town_is_refused_in_one_line_or_sound(carla_net: Path, tmp_path: Path) -> None:
    assert fuzz(carla_net.read_bytes(), 40, 3, tmp_path).total() == 40
