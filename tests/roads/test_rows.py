from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from tmpud.roads import load_map
from tmpud.roads.network import NOWHERE, WHOLE, RoadNetwork, Stretch
from tmpud.roads.rows import from_rows, map_name, to_rows

MARKED = (Stretch(0.0, 10.0), Stretch(20.0, math.inf))


@pytest.fixture
def town() -> RoadNetwork:
    """Return the shipped town with every kind of road marks, lights by name, and lanes in parts."""
    town = load_map("millbrook")
    marks = (WHOLE, NOWHERE, MARKED)
    lanes = {
        lane.id: replace(lane, change_left=marks[i % 3], change_right=marks[i % 2])
        for i, lane in enumerate(town.lanes.values())
    }
    signals = {name: replace(light, lights=("a", "b")) for name, light in town.signals.items()}
    return replace(town, lanes=lanes, signals=signals, parts={"1.0.-1": next(iter(lanes))})


def test_a_network_comes_back_from_json_as_it_was(town: RoadNetwork) -> None:
    text = json.dumps([*to_rows(town)], allow_nan=False)
    assert from_rows(json.loads(text), Path(town.source), town.segment_length) == town


@pytest.mark.parametrize("name", ["town.net.xml", "town.net.xml.gz", "town.xodr", "town"])
def test_a_map_is_called_like_its_file(name: str) -> None:
    assert map_name(Path("there") / name) == "town"
