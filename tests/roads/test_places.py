from __future__ import annotations

import random
from collections import Counter
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.roads.nets import CROSSING
from tmpud.errors import RequestError
from tmpud.roads import load_map, read_sumo_net
from tmpud.roads.moves import reachable
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import SNAP, request, resolve

RNG = random.Random(0)


@cache
def town() -> RoadNetwork:
    return load_map("millbrook")


def test_a_lane_means_its_segments_in_driving_order() -> None:
    assert resolve(town(), "park3e_0", RNG).segments == ("park3e_0/0", "park3e_0/1", "park3e_0/2")


def test_an_edge_means_all_its_lanes_the_rightmost_first() -> None:
    place = resolve(town(), "high3n", RNG)
    assert place.segments == ("high3n_0/0", "high3n_0/1", "high3n_1/0", "high3n_1/1")
    assert place.station is None


@given(segment=st.sampled_from(sorted(town().segments)), share=st.floats(0, 1), offset=st.floats(-1.5, 1.5))
def test_a_position_is_the_nearest_lane_s(segment: str, share: float, offset: float) -> None:
    here = town().segments[segment]
    station = here.start + share * (here.end - here.start)
    pose = town().lanes[here.lane].centre.pose_at(station, offset)
    place = resolve(town(), f"{pose.x:.3f},{pose.y:.3f}", RNG)
    assert place.segments[0].startswith(f"{here.lane}/")
    assert place.station == pytest.approx(station, abs=1.5)  # on a bend a lateral offset moves the station


@pytest.mark.parametrize("text", ["-15.0 , 220", "-15,+220.", "-15.00,220.00"])
def test_a_position_may_be_negative_and_spaced(text: str) -> None:
    assert resolve(town(), text, RNG).segments[0].startswith("west2")


def test_a_position_off_the_road_is_refused_with_the_distance_and_the_nearest_lane() -> None:
    with pytest.raises(RequestError, match=r"the nearest lane, \w+_0, is \d+\.\d m away"):
        resolve(town(), "60,380", RNG)
    with pytest.raises(RequestError, match="m away"):
        resolve(town(), f"60,{300 + 9 + SNAP}", RNG)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("high3m", "did you mean .*high3n"),
        ("9" * 400 + ",0", "not a lane"),
        ("1,nan", "not a lane"),
        ("1e400,2", "not a lane"),
        ("\n" * 99, "named like"),
    ],
)
def test_an_unknown_place_is_refused_in_one_line_with_a_hint(text: str, hint: str) -> None:
    with pytest.raises(RequestError, match=hint) as caught:
        resolve(town(), text, RNG)
    assert "\n" not in str(caught.value)


def test_random_places_depend_on_the_seed_alone() -> None:
    assert request(town(), "random", ["random"], seed=7) == request(town(), "random", ["random"], seed=7)
    assert len({request(town(), "random", ["random"], seed=seed) for seed in range(20)}) == 20


def test_random_places_are_uniform_over_lane_length() -> None:
    rng = random.Random(1)
    lanes = Counter(town().segments[resolve(town(), "random", rng).segments[0]].lane for _ in range(800))
    kilometres = sum(lane.length for lane in town().lanes.values())
    long, short = town().lanes["north3w_0"], town().lanes["church1e_0"]
    for lane in (long, short):
        expected = 800 * lane.length / kilometres
        assert abs(lanes[lane.id] - expected) < 4 * expected**0.5


def test_random_goals_can_be_reached(tmp_path: Path) -> None:
    path = tmp_path / "tiny.net.xml"
    path.write_text(CROSSING)
    network = read_sumo_net(path)  # no circles: its largest strong part is one segment, the first found
    only = resolve(network, "random", random.Random(3)).segments
    with pytest.raises(RequestError, match="reached from the start"):
        resolve(network, "random", RNG, reachable_from=["north_0/0"])
    assert set(only) <= reachable(network, only)


def test_vias_come_before_the_goals() -> None:
    asked = request(town(), "park1e_0", ["high4n"], vias=["park2e_0"])
    assert [place.name for place in asked.goals] == ["park2e_0", "high4n"]
    with pytest.raises(RequestError, match="needs a goal"):
        request(town(), "park1e_0", [])
