import math
from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.judging.drives import car, cruising, judge_all, scene, scenes, slowing
from tests.judging.roads import WIDTH, crossroads
from tmpud.geometry import Pose
from tmpud.judging.comfort import Comfort, time_to_collision
from tmpud.judging.judge import Judge
from tmpud.judging.rules import JudgingRules
from tmpud.scene import Scene, VehicleState

RULES = JudgingRules()
LENGTH = 4.7  # [m] of all cars here


def ttc(ego: VehicleState, *others: VehicleState) -> float:
    return time_to_collision(scene(0.0, ego, *others), RULES)


def watched(drive: Iterable[Scene]) -> Comfort:
    comfort = Comfort(RULES)
    for view in drive:
        comfort.observe(view)
    return comfort


def ego_driving(speed: Callable[[float], float], seconds: float) -> Comfort:
    """Watch an ego with this speed [m/s] at each time [s]; where it is does not matter to the jerk."""
    return watched(scenes(seconds, lambda time: car(0.0, speed=speed(time))))


# Time to collision -------------------------------------------------------------------------------------------------


def test_the_gap_between_bumpers_is_divided_by_the_closing_speed() -> None:
    assert ttc(car(0, speed=5.0), car(10 + LENGTH, speed=1.0)) == pytest.approx(10 / 4)
    assert ttc(car(0, speed=1.0), car(-10 - LENGTH, speed=5.0)) == pytest.approx(10 / 4)


@pytest.mark.parametrize("x", [-15.0, 15.0])
@pytest.mark.parametrize("speed", [3.0, 5.0, 7.0])
def test_only_a_gap_that_closes_counts(x: float, speed: float) -> None:
    closes = speed < 5.0 if x > 0 else speed > 5.0
    assert math.isfinite(ttc(car(0, speed=5.0), car(x, speed=speed))) is closes


def test_the_nearest_in_time_counts_and_not_the_nearest_in_space() -> None:
    ego, near, far = car(0, speed=5.0), car(6 + LENGTH, speed=4.0), car(10 + LENGTH, speed=1.0)
    assert ttc(ego, near, far) == ttc(ego, far, near) == pytest.approx(10 / 4)


@pytest.mark.parametrize("y", [WIDTH, -WIDTH, 1.91])
def test_a_vehicle_that_does_not_overlap_the_ego_sideways_is_passed(y: float) -> None:
    assert ttc(car(0), car(15, y, speed=0.0)) == math.inf
    assert ttc(car(0), car(15, y / 2, speed=0.0)) < math.inf


def test_a_vehicle_beside_the_ego_leaves_no_gap() -> None:
    assert ttc(car(0), car(LENGTH - 0.01, speed=0.0)) == math.inf
    assert ttc(car(0), car(LENGTH + 0.01, speed=0.0)) == pytest.approx(0.01 / 5)


def test_a_vehicle_on_another_level_is_not_met() -> None:
    above = car(15, speed=0.0)
    assert ttc(car(0), replace(above, z=RULES.level)) == math.inf
    assert ttc(car(0), replace(above, z=RULES.level - 0.1)) < math.inf


@pytest.mark.parametrize(("degrees", "counts"), [(44, True), (-44, True), (46, False), (90, False), (180, False)])
def test_a_vehicle_that_goes_another_way_is_not_met(degrees: float, counts: bool) -> None:
    found = ttc(car(0), car(15, speed=0.0, heading=math.radians(degrees)))
    assert math.isfinite(found) is counts


def test_of_a_turned_vehicle_counts_what_it_is_in_the_frame_of_the_ego() -> None:
    turned = math.radians(30)
    cos, sin = math.cos(turned), math.sin(turned)
    gap = 20 - (LENGTH + cos * LENGTH + sin * 1.9) / 2
    assert ttc(car(0), car(20, speed=2.0, heading=turned)) == pytest.approx(gap / (5 - 2 * cos))
    reach = (1.9 + sin * LENGTH + cos * 1.9) / 2
    assert ttc(car(0), car(20, reach - 0.01, speed=2.0, heading=turned)) < math.inf
    assert ttc(car(0), car(20, reach + 0.01, speed=2.0, heading=turned)) == math.inf


def test_without_others_nothing_closes() -> None:
    assert ttc(car(0)) == math.inf


def moved(state: VehicleState, turn: float, x: float, y: float) -> VehicleState:
    cos, sin, pose = math.cos(turn), math.sin(turn), state.pose
    return replace(
        state, pose=Pose(x + cos * pose.x - sin * pose.y, y + sin * pose.x + cos * pose.y, pose.heading + turn)
    )


@given(st.integers(0, 2**32 - 1))
def test_wherever_the_scene_lies_and_however_it_is_turned_it_is_the_same(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cars = [car(0, speed=5.0)] + [
        car(rng.uniform(-40, 40), rng.uniform(-3, 3), speed=rng.uniform(0, 10), heading=rng.uniform(-0.8, 0.8))
        for _ in range(5)
    ]
    turn, x, y = rng.uniform(-math.pi, math.pi), *rng.uniform(-1000, 1000, size=2)
    assert ttc(*(moved(each, turn, x, y) for each in cars)) == pytest.approx(ttc(*cars), rel=1e-6)


def test_of_a_drive_the_least_is_kept() -> None:
    # The one ahead drives as fast as the ego, 20 m away, brakes at 2 m/s^2 for 1 s and goes on 2 m/s slower
    drive = scenes(4.0, cruising(car(0)), slowing(car(20 + LENGTH), 1.0, 2.0, down_to=3.0))
    assert watched(drive).min_ttc == pytest.approx((20 - 1 - 2 * 2) / 2)


def test_a_drive_in_which_nothing_closes_has_no_time_to_collision() -> None:
    assert watched(scenes(4.0, cruising(car(0)), cruising(car(20)))).min_ttc == math.inf


def test_scenes_between_two_looks_are_skipped() -> None:
    def ahead(time: float) -> VehicleState:
        return car(20 + LENGTH, speed=0.0 if 1.0 < time < 1.2 - 1e-9 else 5.0)

    assert watched(scenes(2.0, lambda _: car(0), ahead)).min_ttc == math.inf


# Jerk --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("acceleration", [-0.5, 0.0, 2.0])
def test_a_constant_acceleration_has_no_jerk(acceleration: float) -> None:
    jerk = ego_driving(lambda time: 3.0 + acceleration * time, 4.0).jerk
    assert (jerk.rms, jerk.largest) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert jerk.count == 19


@pytest.mark.parametrize("acceleration", [-2.0, 2.0])
def test_a_step_of_acceleration_at_a_look_is_the_jerk_of_one_interval(acceleration: float) -> None:
    # 2 s are 11 looks, 10 accelerations and 9 changes, one of them of 2 m/s^2 within 0.2 s
    jerk = ego_driving(lambda time: 5.0 + acceleration * max(time - 1.0, 0.0), 2.0).jerk
    assert jerk.largest == pytest.approx(10.0)
    assert jerk.rms == pytest.approx(10 / 3)


def test_a_step_of_acceleration_between_two_looks_is_spread_over_two_intervals() -> None:
    jerk = ego_driving(lambda time: 2.0 * max(time - 1.1, 0.0), 2.0).jerk
    assert jerk.largest == pytest.approx(5.0)
    assert jerk.rms == pytest.approx(math.sqrt(2 * 5.0**2 / 9))


@given(st.floats(-3, 3))
def test_a_constant_jerk_is_found_as_it_is(rate: float) -> None:
    jerk = ego_driving(lambda time: 5.0 + rate * time**2 / 2, 3.0).jerk
    assert (jerk.rms, jerk.largest) == pytest.approx((abs(rate), abs(rate)), abs=1e-9)


def test_noise_that_is_gone_at_each_look_does_not_count() -> None:
    def shaken(time: float) -> float:
        return 5.0 + 0.05 * math.sin(math.tau * time / 0.2)

    assert ego_driving(shaken, 3.0).jerk.largest == pytest.approx(0.0, abs=1e-6)


def test_looks_that_are_not_evenly_spaced_find_the_same_constant_jerk() -> None:
    times = np.cumsum(np.random.default_rng(0).uniform(0.2, 0.5, size=50)).tolist()
    jerk = watched(scene(time, car(0, speed=time**2)) for time in times).jerk
    assert (jerk.rms, jerk.largest) == pytest.approx((2.0, 2.0))


# What the judge makes of it ----------------------------------------------------------------------------------------


def metrics(*drive: Scene) -> dict[str, float]:
    judge = Judge(crossroads())
    judge_all(judge, drive)
    return judge.metrics


def test_the_judge_reports_them_rounded() -> None:
    found = metrics(*scenes(2.0, cruising(car(0)), cruising(car(20 + LENGTH, speed=2.0))))
    assert found["min_ttc"] == pytest.approx((20 - 2 * 3) / 3, abs=5e-4)
    assert (found["rms_jerk"], found["max_jerk"]) == (0.0, 0.0)
    assert found["min_ttc"] == round(found["min_ttc"], 3)


def test_what_there_is_nothing_to_take_from_is_left_out() -> None:
    assert set(metrics(scene(0.0, car(0)))) == {"collisions", "forced_stops", "violations"}
    # Three speeds make one change of acceleration
    assert "max_jerk" not in metrics(*scenes(0.35, cruising(car(0))))
    assert "max_jerk" in metrics(*scenes(0.4, cruising(car(0))))


def test_after_a_collision_from_the_side_the_time_to_collision_is_zero() -> None:
    crossing = car(6, -4, "side_0", heading=math.pi / 2, name="other")
    found = metrics(scene(0.0, car(0), crossing), scene(0.05, car(0), replace(crossing, pose=Pose(1, -1, math.pi / 2))))
    assert (found["collisions"], found["min_ttc"]) == (1, 0.0)
