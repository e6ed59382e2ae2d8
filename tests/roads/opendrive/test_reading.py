from __future__ import annotations

import math
import os
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.conftest import SHARED_MAPS
from tests.roads.mutations import MUTATIONS, outcome
from tests.roads.opendrive.crossroads import crossroads
from tmpud.errors import MapError
from tmpud.planning import Problem
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive import reading
from tmpud.roads.opendrive.reading import read_opendrive
from tmpud.roads.sumo_net import read_sumo_net


def test_damaged_maps_are_refused_in_one_line_or_sound(town: RoadNetwork, tmp_path: Path) -> None:
    rng, found = random.Random(5), Counter[bool]()
    for _ in range(12):
        damaged = rng.choice(MUTATIONS)(crossroads().encode(), rng)
        message = outcome(read_opendrive, tmp_path / f"{town.name}.xodr", damaged, slow=math.inf)
        assert "did not end" not in message
        found[message == ""] += 1
    assert found[False] > 3


def test_a_map_that_ends_carlas_parser_is_refused_and_this_process_goes_on(
    town: RoadNetwork, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\nkill -SEGV $$\n")
    python.chmod(0o755)
    monkeypatch.setattr("sys.executable", str(python))
    with pytest.raises(MapError, match="CARLA's parser cannot read it: it ended with SIGSEGV"):
        read_opendrive(Path(town.source))


def test_without_carlas_client_the_extra_and_the_other_way_are_named(
    crossroads_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "has_carla", lambda: False)
    with pytest.raises(MapError, match=r"tmpud\[carla\].*tmpud map import") as caught:
        read_opendrive(crossroads_file)
    assert "\n" not in str(caught.value)


def test_carlas_client_is_never_loaded_into_this_process(town: RoadNetwork) -> None:
    code = f"import sys, tmpud.roads as r; r.load_map({town.source!r}); print({{'carla', 'numpy'}} & set(sys.modules))"
    environment = {**os.environ, "TMPUD_NO_CACHE": "1"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout.strip() == "set()"


def test_a_parser_that_hangs_is_given_up(
    town: RoadNetwork, crossroads_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert town.lanes
    monkeypatch.setattr(reading, "TIME_LIMIT", 0.001)
    with pytest.raises(MapError, match="did not end within"):
        read_opendrive(crossroads_file)


def test_a_map_read_before_is_the_same_from_the_cache(
    town: RoadNetwork, crossroads_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("TMPUD_NO_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    first = load_map(crossroads_file)
    monkeypatch.setattr(reading, "has_carla", lambda: False)  # it is not read again
    assert load_map(crossroads_file) == first == town


def test_plans_are_made_on_it(town: RoadNetwork) -> None:
    report = Problem.of(town.source, "1.0.-2", "3.0.-1").solve()
    assert report.optimal
    assert [step.action.value for step in report.plan].count("turnleft") == 1
    assert [step.action.value for step in report.plan].count("mergeleft") == 1


@pytest.mark.parametrize("name", ["Town01", "Town05"])
def test_the_sumo_net_of_the_same_town_has_the_same_lanes_and_turns(name: str) -> None:
    net, file = (SHARED_MAPS / f"{name}{suffix}" for suffix in (".net.xml", ".xodr"))
    if not (net.is_file() and file.is_file() and reading.has_carla()):
        pytest.skip(f"{name} is not there in both formats, or CARLA's client is not")
    sumo, carla = read_sumo_net(net), read_opendrive(file)
    length = [sum(lane.length for lane in town.lanes.values()) for town in (sumo, carla)]
    assert length[1] == pytest.approx(length[0], rel=0.01)
    for action in ("turnleft", "turnright"):
        found = [sum(way.action == action for way in town.connections) for town in (sumo, carla)]
        assert found[1] == pytest.approx(found[0], rel=0.05)
    (dx, dy) = sumo.frame.offset
    for lane in sumo.lanes.values():
        x, y, _ = lane.centre.pose_at(lane.length / 2)
        _, _, offset = carla.locate(x - dx, y - dy)
        assert abs(offset) < 0.2
