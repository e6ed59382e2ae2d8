from dataclasses import replace

import pytest

from tests.judging.drives import Motion, car, cruising, judge_all, merging, scenes, slowing
from tests.judging.roads import WIDTH, crossroads
from tmpud.judging.judge import Judge
from tmpud.judging.rules import Kind, Verdict
from tmpud.scene import VehicleState

EGO = car(20, speed=4.0)


def behind(x: float = 10.0, y: float = WIDTH, lane: str = "in_1", speed: float = 5.0) -> VehicleState:
    return car(x, y, lane, speed, name="follower")


def judged(*others: Motion, ego: Motion | None = None, seconds: float = 10.0, merges: bool = True) -> Judge:
    """Judge a drive in which the ego merges from in_0 to in_1 at its start and is across after 1 s."""
    judge = Judge(crossroads())
    drive = list(scenes(seconds, ego or merging(EGO, 1.0, WIDTH, "in_1"), *others))
    if merges:
        judge.merge_began(drive[0], "in_0", "in_1", "mergeleft(in_0/0)")
    judge_all(judge, drive)
    return judge


def stops(judge: Judge) -> list[tuple[str | None, str]]:
    return [(verdict.vehicle, verdict.rule) for verdict in judge.forced_stops]


def test_a_follower_that_must_stop_behind_a_faster_ego_is_a_forced_stop_once() -> None:
    judge = judged(slowing(behind(), 1.5, 3.0))
    assert stops(judge) == [("follower", "mergeleft(in_0/0)")]
    (verdict,) = judge.verdicts
    assert verdict.time == pytest.approx(1.5 + 4 / 3, abs=0.06)
    assert verdict.blame == "ego"


def test_without_a_merge_a_follower_that_stops_is_nothing() -> None:
    assert judged(slowing(behind(), 1.5, 3.0), merges=False).verdicts == ()


def test_a_follower_that_only_slows_down_is_nothing() -> None:
    assert judged(slowing(behind(), 1.5, 3.0, down_to=1.2)).verdicts == ()


def test_a_follower_that_stood_when_the_merge_began_is_queueing() -> None:
    assert stops(judged(slowing(behind(speed=2.0), 1.5, 3.0))) == []


def test_a_follower_that_stopped_before_the_ego_was_across_is_not_counted() -> None:
    assert stops(judged(slowing(behind(), 0.0, 8.0))) == []


def test_a_stop_more_than_eight_seconds_after_the_start_is_not_counted() -> None:
    assert stops(judged(slowing(behind(-5), 7.5, 3.0))) == []
    assert stops(judged(slowing(behind(-5), 6.5, 3.0))) == [("follower", "mergeleft(in_0/0)")]


def test_a_follower_that_stops_behind_a_queueing_ego_is_in_the_queue_itself() -> None:
    ego_in_lane = merging(EGO, 1.0, WIDTH, "in_1")

    def queueing(time: float) -> VehicleState:
        moved = slowing(replace(EGO, pose=ego_in_lane(0).pose), 1.5, 3.0)(time)
        return replace(ego_in_lane(time), pose=moved.pose._replace(y=ego_in_lane(time).pose.y), speed=moved.speed)

    assert stops(judged(slowing(behind(5), 1.8, 3.0), ego=queueing)) == []


def test_an_ego_that_drives_off_later_does_not_make_an_old_stop_a_forced_one() -> None:
    def ego(time: float) -> VehicleState:
        return replace(merging(EGO, 1.0, WIDTH, "in_1")(time), speed=1.0 if time < 5 else 5.0)

    assert stops(judged(slowing(behind(0), 1.5, 3.0), ego=ego)) == []


def test_the_car_behind_the_follower_and_the_cars_ahead_are_not_forced() -> None:
    leader = cruising(car(40, WIDTH, "in_1", 5.0, name="leader"))
    braking_leader = slowing(car(45, WIDTH, "in_1", 5.0, name="leader"), 1.5, 1.5)
    second = slowing(car(-10, WIDTH, "in_1", 5.0, name="second"), 1.5, 3.0)
    assert stops(judged(leader, slowing(behind(), 1.5, 1.0, down_to=2.0), second)) == []
    assert stops(judged(braking_leader, cruising(behind(0, speed=3.0)), seconds=4.0)) == []


def test_a_car_between_the_ego_and_the_follower_is_its_leader() -> None:
    between = cruising(car(14, WIDTH, "in_1", 4.0, name="between"))
    assert stops(judged(between, slowing(behind(4), 1.5, 3.0))) == []


def test_cars_on_the_origin_lane_or_beside_are_not_forced() -> None:
    assert stops(judged(slowing(behind(5, 0.0, "in_0"), 1.5, 3.0))) == []


def test_an_ego_that_never_crosses_forces_nobody() -> None:
    assert stops(judged(slowing(behind(), 1.5, 3.0), ego=cruising(EGO))) == []


@pytest.mark.parametrize("order", ["before", "after"])
def test_a_trial_with_a_collision_has_no_forced_stop(order: str) -> None:
    hit_at = 1.2 if order == "before" else 5.0
    start = 20 + 4.0 * hit_at + 4.6
    obstacle = cruising(car(start, WIDTH, "out_1", 0.0, name="obstacle"))
    judge = judged(obstacle, slowing(behind(), 1.5, 3.0), seconds=6.0)
    assert len(judge.collisions) >= 1
    assert stops(judge) == []
    found = [verdict for verdict in judge.verdicts if verdict.kind is Kind.FORCED_STOP]
    assert len(found) == (0 if order == "before" else 1)


def braked(judge: Judge) -> list[Verdict]:
    return [verdict for verdict in judge.verdicts if verdict.kind is Kind.HARD_BRAKING]


def test_hard_braking_behind_the_ego_is_recorded_once_beside_the_stop() -> None:
    judge = judged(slowing(behind(), 1.5, 5.0))
    assert [verdict.vehicle for verdict in braked(judge)] == ["follower"]
    assert stops(judge) == [("follower", "mergeleft(in_0/0)")]
    assert judge.violations == ()


def test_a_car_that_stood_when_the_merge_began_may_brake_hard() -> None:
    starting = behind(0, speed=5.0)

    def late(time: float) -> VehicleState:
        return slowing(starting, 2.0, 6.0, down_to=2.0)(time) if time > 0 else replace(starting, speed=0.0)

    assert braked(judged(late)) == []


def test_gentle_braking_and_braking_elsewhere_is_not_recorded() -> None:
    assert braked(judged(slowing(behind(), 1.5, 4.4, down_to=2.0))) == []
    assert braked(judged(slowing(behind(0, 0.0, "in_0"), 1.5, 6.0, down_to=2.0))) == []
    assert braked(judged(slowing(behind(), 0.1, 6.0, down_to=3.0))) == []
