import math
from dataclasses import replace

import numpy as np
import pytest

from tests.judging.roads import crossroads
from tests.safety.fakes import MERGELEFT, car, scene
from tmpud.safety.gaps import MergeGaps, RssParameters, lane_gaps, merge_gaps, safe_distance
from tmpud.scene import VehicleState

NETWORK = crossroads()  # the ego is at x = 20 on in_0 at 5 m/s; in_1 lies 3.2 m to its left
LENGTH = 4.7  # [m] of every car
CLEAR = MergeGaps(math.inf, math.inf, math.inf)


def scores(*others: VehicleState, ego: VehicleState | None = None) -> MergeGaps:
    return merge_gaps(scene(*others, ego=ego), MERGELEFT, NETWORK)


def beside(x: float, speed: float = 5.0) -> VehicleState:
    return car(x, 3.2, speed=speed, lane="in_1")


def test_an_empty_lane_has_nothing_to_hit() -> None:
    assert scores() == CLEAR


@pytest.mark.parametrize(
    "elsewhere",
    [
        car(25, 0, lane="in_0"),
        replace(beside(25), z=6.0),
        car(25, 3.2, math.pi, lane="in_1"),
        car(25, 3.2, math.pi / 2, lane="in_1"),
    ],
    ids=["own lane", "bridge", "oncoming", "crossing"],
)
def test_only_cars_that_drive_along_the_target_lane_count(elsewhere: VehicleState) -> None:
    assert scores(elsewhere) == CLEAR


def test_a_car_that_reaches_into_the_target_lane_counts_wherever_its_centre_is() -> None:
    straddling = car(30, 1.0, lane="in_0")
    assert scores(straddling).gap == pytest.approx(10 - LENGTH)


@pytest.mark.parametrize("x", [10.0, 30.0])
def test_the_gap_is_between_the_boxes_ahead_and_behind(x: float) -> None:
    assert scores(beside(x)).gap == pytest.approx(10 - LENGTH)


def test_side_by_side_the_gap_is_negative_and_no_time_is_left() -> None:
    found = scores(beside(21))
    assert found.gap == pytest.approx(1 - LENGTH)
    assert found.time_to_collision == 0.0
    assert found.rss_ratio < 0


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (beside(10, speed=7.0), (10 - LENGTH) / 2),
        (beside(30, speed=3.0), (10 - LENGTH) / 2),
        (beside(10, speed=3.0), math.inf),
        (beside(30, speed=7.0), math.inf),
        (beside(30, speed=5.0), math.inf),
    ],
    ids=["faster behind", "slower ahead", "slower behind", "faster ahead", "as fast"],
)
def test_only_a_gap_that_closes_has_a_time_to_collision(other: VehicleState, expected: float) -> None:
    assert scores(other).time_to_collision == pytest.approx(expected)


def test_the_worst_car_counts_for_each_score_by_itself() -> None:
    near, fast = beside(12.0, speed=5.0), beside(0.0, speed=12.0)
    both = scores(near, fast)
    assert both == MergeGaps(*(min(pair) for pair in zip(scores(near), scores(fast), strict=True)))
    assert both.gap == scores(near).gap
    assert both.time_to_collision == scores(fast).time_to_collision


def test_rss_calls_a_gap_of_the_safe_distance_just_safe() -> None:
    needed = float(safe_distance(np.array([8.0]), np.array([5.0]), RssParameters())[0])
    ego = car(60, 0, speed=5.0, name="ego", lane="in_0")
    assert scores(beside(60 - LENGTH - needed, speed=8.0), ego=ego).rss_ratio == pytest.approx(1.0)


def test_who_is_behind_needs_more_room_the_faster_it_is_and_less_the_faster_the_one_ahead() -> None:
    speeds = np.linspace(0.0, 15.0, 50)
    assert (np.diff(safe_distance(speeds, np.full(50, 5.0), RssParameters())) > 0).all()
    assert (np.diff(safe_distance(np.full(50, 5.0), speeds, RssParameters())) <= 0).all()


def test_all_of_a_lane_s_cars_are_found() -> None:
    found = lane_gaps(scene(*(beside(x) for x in (0.0, 40.0, 60.0)), car(40, 0)), NETWORK.lanes["in_1"])
    assert found.gap == pytest.approx([20 - LENGTH, 20 - LENGTH, 40 - LENGTH])


def test_the_safe_distance_is_that_of_the_ad_rss_library() -> None:
    oracle = pytest.importorskip("tests.safety.rss_oracle")
    rng = np.random.default_rng(5)
    for _ in range(300):
        rear, front = rng.uniform(0, 30, size=2)
        least = rng.uniform(1, 6)
        rss = RssParameters(
            rng.uniform(0.1, 3), rng.uniform(0.1, 3), least, least + rng.uniform(0, 6), rng.uniform(0, 3)
        )
        ours = float(safe_distance(np.array([rear]), np.array([front]), rss)[0])
        assert ours == pytest.approx(oracle.safe_distance(rear, front, rss), abs=1e-9)
