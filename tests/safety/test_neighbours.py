import math
from dataclasses import replace

import numpy as np
import pytest

from tests.judging.roads import crossroads
from tests.safety.fakes import FORWARD, MERGELEFT, FakeMotion, car, scene
from tmpud.presets import RELEASED, TMPUD, Preset
from tmpud.safety.estimator import SafeSetEstimator
from tmpud.scene import VehicleState
from tmpud.symbols import Transition

NETWORK = crossroads()
CONFLICTING = replace(TMPUD, lane_keeping="conflicting vehicles")
ALL = replace(TMPUD, lane_keeping="all vehicles")


def looked_at(
    *others: VehicleState,
    step: Transition = FORWARD,
    preset: Preset = CONFLICTING,
    ego: VehicleState | None = None,
    motion: FakeMotion | None = None,
) -> tuple[str, ...]:
    estimator = SafeSetEstimator(preset, motion or FakeMotion(), NETWORK)
    return estimator.estimate(step, scene(*others, ego=ego), np.random.default_rng(0)).ids


def test_a_queue_on_its_own_lane_is_no_danger_to_an_action_that_keeps_the_lane() -> None:
    queue = [car(28, 0, speed=0.0, lane="in_0"), car(12, 0, lane="in_0")]
    assert looked_at(*queue) == ()
    assert len(looked_at(*queue, preset=ALL)) == 2
    assert len(looked_at(*queue, step=MERGELEFT)) == 2


def test_a_car_driving_parallel_in_the_next_lane_is_only_looked_at_by_a_merge() -> None:
    parallel = car(22, 3.2, lane="in_1")
    assert looked_at(parallel) == ()
    assert looked_at(parallel, step=MERGELEFT) == (parallel.id,)


@pytest.mark.parametrize(("aside", "expected"), [(2.39, 1), (2.41, 0)])
def test_half_a_metre_between_two_boxes_is_enough(aside: float, expected: int) -> None:
    assert len(looked_at(car(22, aside, lane="in_1"))) == expected


def test_the_leader_on_the_lane_the_ego_is_still_on_is_car_following() -> None:
    assert looked_at(car(30, 0, speed=2.0, lane="in_0"), motion=FakeMotion(path=("out_0",))) == ()


def test_a_car_that_swings_into_the_path_is_looked_at() -> None:
    swinging = replace(car(24, 3.2, lane="in_1"), yaw_rate=-0.3)
    assert looked_at(swinging) == (swinging.id,)


def test_a_car_that_crosses_the_path_quickly_is_not_missed_between_two_instants() -> None:
    coarse = replace(CONFLICTING, interval=1.0)
    crosser = car(35, -10.5, math.pi / 2, speed=8.0, lane="side_0")
    assert looked_at(crosser, preset=coarse) == (crosser.id,)


def test_a_car_whose_path_ends_before_the_ego_s_path_is_not_looked_at() -> None:
    assert looked_at(car(30, -20, math.pi / 2, speed=2.0, lane="side_0")) == ()


def test_followers_on_the_way_the_ego_came_are_car_following_but_cars_joining_ahead_are_not() -> None:
    follower = car(118, 0, lane=":J_0_0", name="follower")
    leaving = car(125, 0, name="ego", lane="out_0")
    assert looked_at(follower, ego=leaving, motion=FakeMotion(path=("out_0",))) == ()
    entering = car(101, 0, name="ego", lane=":J_0_0")
    joining = car(114, -1, 0.2, lane=":J_4_0", name="joining")
    behind = car(95, 0, lane="in_0", name="behind")
    ahead = FakeMotion(path=(":J_0_0", "out_0"))
    assert looked_at(joining, behind, ego=entering, motion=ahead) == ("joining",)


def test_the_path_of_an_ego_that_stands_is_where_it_stands() -> None:
    passing = car(10, 1.0, speed=8.0, name="passing")
    assert looked_at(passing, car(10, 6, name="apart"), ego=car(20, 0, speed=0.0, lane="in_0")) == ("passing",)


def test_the_released_code_looks_at_the_target_lane_within_sixty_degrees() -> None:
    preset = replace(RELEASED, share="exact")
    others = [
        car(25, 3.2, lane="in_1", name="beside"),
        car(25, 3.2, math.radians(59), lane="in_1", name="turned"),
        car(25, 3.2, math.radians(-61), lane="in_1", name="turned away"),
        car(30, 0, lane="in_0", name="leader"),
    ]
    assert looked_at(*others, preset=preset, step=MERGELEFT) == ("beside", "turned")


def test_headings_are_compared_the_short_way_round() -> None:
    preset = replace(ALL, neighbour_heading=math.radians(30))
    west = car(20, 0, math.radians(-175), name="ego", lane="in_0")
    assert looked_at(car(10, 3, math.radians(170), name="close"), ego=west, preset=preset) == ("close",)
