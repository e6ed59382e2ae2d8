from __future__ import annotations

import os
import random
from pathlib import Path

import pytest

from tests.conftest import SHARED_MAPS
from tests.roads.opendrive.crossroads import crossroads
from tmpud.errors import MapError
from tmpud.planning import Problem
from tmpud.roads.netconvert import import_net
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive.reading import has_carla, read_opendrive
from tmpud.roads.places import resolve
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.symbols import Action


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "crossroads.xodr"
    path.write_text(crossroads())
    return path


def test_a_net_keeps_the_maps_coordinates_widths_turns_and_lights(file: Path, tmp_path: Path) -> None:
    net = tmp_path / "made" / "crossroads.net.xml.gz"
    assert import_net(file, net).name == "crossroads"
    town = read_sumo_net(net)
    assert town.frame.offset == (0.0, 0.0)
    lane, _, offset = town.locate(100.0, -5.25)
    assert (lane.index, lane.width, abs(offset)) == pytest.approx((0, 3.5, 0.0), abs=0.02)
    turns = [way.action for way in town.connections]
    assert (turns.count(Action.TURNLEFT), turns.count(Action.TURNRIGHT)) == (6, 6)
    assert {way.signal for way in town.connections if way.junction == "100"} == {"100"}
    assert len(town.signals) == 1


def test_the_same_file_makes_the_same_net_byte_for_byte(file: Path, tmp_path: Path) -> None:
    for name in ("one", "two"):
        import_net(file, tmp_path / name / "town.net.xml.gz")
    one, two = (tmp_path / name / "town.net.xml.gz" for name in ("one", "two"))
    assert one.read_bytes() == two.read_bytes()


def test_what_netconvert_refuses_is_one_line_and_leaves_the_old_net(file: Path, tmp_path: Path) -> None:
    net = tmp_path / "town.net.xml"
    net.write_text("the old one")
    text = file.read_text()
    for damaged in (text[: len(text) // 2], text.replace('type="driving"', 'type="none"'), "<OpenDRIVE/>"):
        file.write_text(damaged)
        with pytest.raises(MapError) as caught:
            import_net(file, net)
        assert "\n" not in str(caught.value)
        assert net.read_text() == "the old one"
    assert {path.name for path in tmp_path.iterdir()} == {file.name, net.name}


def test_where_netconvert_is_missing_the_extra_is_named(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    monkeypatch.setattr("sys.executable", os.devnull)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(MapError, match=r"tmpud\[maps\]"):
        import_net(file, file.with_name("town.net.xml"))


def test_carlas_town_has_as_many_lanes_turns_and_lights_by_either_way(tmp_path: Path) -> None:
    file = SHARED_MAPS / "Town01.xodr"
    if not (file.is_file() and has_carla()):
        pytest.skip("Town01 or CARLA's client is not there")
    net, town = import_net(file, tmp_path / "Town01.net.xml"), read_opendrive(file)
    assert len(net.lanes) == len(town.lanes)
    assert len(net.connections) == len(town.connections)
    assert len(net.signals) == len(town.signals)
    assert sorted(way.action for way in net.connections) == sorted(way.action for way in town.connections)
    for lane in net.lanes.values():
        here, _, offset = town.locate(*lane.centre.pose_at(lane.length / 2)[:2])
        assert abs(offset) < 0.1
        assert abs(here.length - lane.length) < 1.0
    for seed in range(5):
        places = [resolve(town, "random", random.Random(seed + end)) for end in (0, 100)]
        start, goal = (_position(town, place.segments[0]) for place in places)
        carla, sumo = (Problem.of(each.source, start, goal).solve() for each in (town, net))
        assert sumo.cost_m == pytest.approx(carla.cost_m, rel=0.005)
        assert [step.action for step in sumo.plan] == [step.action for step in carla.plan]


def _position(town: RoadNetwork, segment: str) -> str:
    """Return the middle of a segment as users write positions."""
    part = town.segments[segment]
    x, y, _ = town.lanes[part.lane].centre.pose_at(part.middle)
    return f"{x:.3f},{y:.3f}"
