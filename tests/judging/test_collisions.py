import math
from dataclasses import replace

import pytest

from tests.judging.drives import car, cruising, judge_all, merging, scene, scenes
from tests.judging.roads import WIDTH, crossroads
from tmpud.judging.judge import Judge
from tmpud.judging.rules import Kind, Verdict
from tmpud.scene import Scene, VehicleState

NETWORK = crossroads()


def collisions(*views: Scene, merge: tuple[str, str] | None = None) -> list[Verdict]:
    judge = Judge(NETWORK)
    if merge:
        judge.merge_began(views[0], *merge, "mergeleft(in_0/0)")
    return [verdict for verdict in judge_all(judge, views) if verdict.kind is Kind.COLLISION]


def touching(other: VehicleState, ego: VehicleState | None = None) -> Verdict:
    (verdict,) = collisions(scene(0.0, ego or car(50), other))
    return verdict


def test_a_collision_counts_once_at_its_first_frame() -> None:
    standing = car(30, speed=0.0, name="standing")
    drive = scenes(4.0, cruising(car(20)), cruising(standing))
    found = collisions(*drive)
    assert [(v.vehicle, v.rule, v.blame) for v in found] == [("standing", "other", "ego")]
    assert found[0].time == pytest.approx((10 - 4.7) / 5, abs=0.05)


def test_every_vehicle_hit_is_named() -> None:
    found = collisions(scene(0.0, car(50), car(54, name="a"), car(46, name="b"), car(40, name="c")))
    assert {(v.vehicle, v.rule, v.blame) for v in found} == {("a", "other", "ego"), ("b", "rear-end", "other")}


def test_a_car_on_a_bridge_above_is_not_hit() -> None:
    assert collisions(scene(0.0, car(50), replace(car(50, name="above"), z=3.0))) == []


@pytest.mark.parametrize(("ego_speed", "blame"), [(5.0, "ego"), (0.0, "other")])
def test_a_crossing_car_at_the_front_bumper_is_the_ego_s_fault_if_it_moved(ego_speed: float, blame: str) -> None:
    verdict = touching(car(53, heading=math.pi / 2, name="crosser"), car(50, speed=ego_speed))
    assert (verdict.rule, verdict.blame) == ("crossing", blame)


def test_a_car_that_runs_into_the_ego_s_side_is_to_blame() -> None:
    verdict = touching(car(50, -3, heading=math.pi / 2, name="crosser"))
    assert (verdict.rule, verdict.blame) == ("crossing", "other")


def test_a_car_that_hits_the_rear_from_another_direction_is_crossing() -> None:
    assert touching(car(46.5, heading=math.radians(60), name="a")).rule == "crossing"
    assert touching(car(46.5, heading=math.radians(40), name="a")).rule == "rear-end"


@pytest.mark.parametrize(("x", "y", "heading"), [(50.5, 1.8, -0.1), (50.2, 1.8, 0.0), (48.5, -2.5, 0.7)])
def test_a_contact_at_the_side_without_a_merge_is_of_another_class(x: float, y: float, heading: float) -> None:
    verdict = touching(car(x, y, heading=heading, name="beside", lane="in_1"))
    assert verdict.rule == "other"


def test_of_two_merges_the_latest_answers() -> None:
    judge = Judge(NETWORK)
    judge.merge_began(scene(0.0, car(50)), "in_0", "in_1", "mergeleft")
    judge.merge_began(scene(3.0, car(65, WIDTH, "in_1")), "in_1", "in_0", "mergeright")
    (verdict,) = judge.observe(scene(4.0, car(70, WIDTH, "in_1"), car(74, WIDTH, "in_1", name="leader")))
    assert verdict.detail.endswith("1.0 s after the start of mergeright")


def test_a_merge_answers_for_cars_on_both_of_its_lanes_from_its_start() -> None:
    ego = merging(car(50), 1.0, WIDTH, "in_1")
    for lane, y in (("in_1", WIDTH), ("in_0", 0.0)):
        other = cruising(car(50 + (8 if lane == "in_0" else 0), y, lane, 5.0 if lane == "in_1" else 0.0, name="other"))
        (verdict,) = collisions(*scenes(2.0, ego, other), merge=("in_0", "in_1"))
        assert (verdict.rule, verdict.blame, verdict.vehicle) == ("merge", "ego", "other")
        assert "mergeleft(in_0/0)" in verdict.detail


def test_a_merge_does_not_answer_for_crossing_cars_or_other_lanes() -> None:
    began = scene(0.0, car(50))
    crosser = scene(0.1, car(50.5), car(53, 1, "in_1", heading=math.pi / 2, name="crosser"))
    assert collisions(began, crosser, merge=("in_0", "in_1"))[0].rule == "crossing"
    elsewhere = scene(0.1, car(50.5), car(53, 1, "out_0", name="elsewhere"))
    assert collisions(began, elsewhere, merge=("in_0", "in_1"))[0].rule == "other"


@pytest.mark.parametrize(("crosses_at", "rule"), [(1.0, "rear-end"), (99.0, "merge")])
def test_a_merge_answers_for_eight_seconds_or_as_long_as_it_is_under_way(crosses_at: float, rule: str) -> None:
    ego = merging(car(20, speed=1.0), crosses_at, WIDTH, "in_1")
    hit_at = 8.5
    y = WIDTH if crosses_at < hit_at else 0.0
    follower = car(20 + hit_at - 4.6 - 5 * hit_at, y, "in_1" if y else "in_0", 5.0, name="follower")
    found = collisions(*scenes(9.0, ego, cruising(follower)), merge=("in_0", "in_1"))
    assert [(v.rule, v.vehicle) for v in found] == [(rule, "follower")]
    assert found[0].time > 8.0


def test_a_merge_given_up_by_driving_on_through_the_junction_is_no_longer_under_way() -> None:
    began, left = scene(0.0, car(80)), scene(9.0, car(110, lane=":J_0_0"))
    hit = scene(20.0, car(125, lane="out_0"), car(128, lane="in_0", name="misplaced"))
    assert collisions(began, left, hit, merge=("in_0", "in_1"))[0].rule == "other"
