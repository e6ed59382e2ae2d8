import math
from dataclasses import replace

import pytest

from tests.judging.drives import STEP, Motion, car, cruising, judge_all, scene, scenes, slowing
from tests.judging.roads import WIDTH, crossroads
from tmpud.geometry import Pose
from tmpud.judging.judge import Judge
from tmpud.judging.rules import Kind, Verdict
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Scene, VehicleState


def through(start: float = 90.0, inside: str = ":J_0_0", after: str = "out_0", speed: float = 5.0) -> Motion:
    """Return a drive along y = 0 through the junction."""

    def motion(time: float) -> VehicleState:
        x = start + speed * time
        return car(x, lane="in_0" if x < 100 else inside if x < 120 else after, speed=speed)

    return motion


def lit(drive: list[Scene], letters: dict[float, str]) -> list[Scene]:
    """Show a light's letters, each from an instant on."""
    shown = [[text for start, text in letters.items() if start <= view.time][-1] for view in drive]
    return [replace(view, signals={"J": text}) for view, text in zip(drive, shown, strict=True)]


def found(drive: list[Scene], network: RoadNetwork | None = None) -> list[Verdict]:
    judge = Judge(network or crossroads())
    judge_all(judge, drive)
    assert judge.violations == judge.verdicts
    return list(judge.verdicts)


def kinds(drive: list[Scene], network: RoadNetwork | None = None) -> list[str]:
    return [verdict.kind for verdict in found(drive, network)]


def test_crossing_on_red_is_one_violation_that_names_the_light() -> None:
    (verdict,) = found(lit(list(scenes(8, through())), {0: "rGGGG"}))
    assert (verdict.kind, verdict.rule, verdict.blame, verdict.vehicle) == (Kind.RED_LIGHT, "J:0", "ego", None)
    assert "in_0" in verdict.detail


@pytest.mark.parametrize("letters", ["Grrrr", "yrrrr", "grrrr", "orrrr", ""])
def test_only_the_red_of_its_own_connection_counts(letters: str) -> None:
    assert kinds(lit(list(scenes(8, through())), {0: letters})) == []


def test_the_light_counts_when_the_bumper_crosses_and_not_when_the_centre_does() -> None:
    bumper_at = (100 - 90 - 4.7 / 2) / 5
    drive = list(scenes(8, through()))
    assert kinds(lit(drive, {0: "G", bumper_at + 0.1: "r"})) == []
    assert kinds(lit(drive, {0: "r", bumper_at + 0.1: "G"})) == ["red_light"]
    assert kinds(lit(drive, {0: "r", bumper_at - 0.1: "G"})) == []


def test_standing_before_a_red_light_is_allowed() -> None:
    waiting = slowing(car(85), 0.5, 2.0)
    assert kinds(lit(list(scenes(8, waiting)), {0: "rrrrr"})) == []


def test_a_junction_lane_the_simulator_mixes_up_is_settled_by_the_lane_reached() -> None:
    drive = list(scenes(8, through(inside=":J_4_0")))
    assert kinds(lit(drive, {0: "rGGGG"})) == ["red_light"]
    assert kinds(lit(drive, {0: "GGGGr"})) == []


def test_a_drive_that_starts_in_the_junction_crosses_no_line() -> None:
    assert kinds(lit(list(scenes(3, through(start=101))), {0: "rrrrr"})) == []
    assert kinds(lit(list(scenes(3, through(start=98))), {0: "rrrrr"})) == []


def northwards(stands_at: float | None, seconds: float) -> list[Scene]:
    """Return a drive along the side road at 4 m/s that may stand for a second with its front at a place."""

    def motion(time: float) -> VehicleState:
        y = -30 + 4 * time
        stop = math.inf if stands_at is None else stands_at - 4.7 / 2
        waiting = 0 <= time - (stop + 30) / 4 < 1
        if time >= (stop + 30) / 4:
            y = max(stop, y - 4)
        lane = "side_0" if y < -10 else ":J_3_0" if y < 10 else "north_0"
        return car(110, y, lane, 0.0 if waiting else 4.0, math.pi / 2)

    return list(scenes(seconds, motion))


@pytest.mark.parametrize("letter", ["s", "w"])
@pytest.mark.parametrize(("stands_at", "expected"), [(None, 1), (-16.0, 1), (-14.5, 0), (-10.5, 0), (-9.0, 1)])
def test_a_stop_sign_asks_for_a_stand_within_five_metres_before_its_line(
    letter: str, stands_at: float | None, expected: int
) -> None:
    network = _unsignalled(crossroads(letter))
    assert kinds(northwards(stands_at, 11), network) == ["stop_line"] * expected


def test_a_give_way_sign_asks_for_no_stand() -> None:
    assert kinds(northwards(None, 10), _unsignalled(crossroads("m"))) == []


def test_where_a_light_rules_the_stop_sign_does_not() -> None:
    assert kinds(northwards(None, 10), crossroads("s")) == []


def _unsignalled(network: RoadNetwork) -> RoadNetwork:
    ways = tuple(replace(way, signal=None) for way in network.connections)
    return RoadNetwork("crossroads", network.lanes, ways, {}, {})


def drift(time: float) -> VehicleState:
    """Drive off the right border of in_0 and come back, twice."""
    y = -2.5 * math.sin(math.pi * time / 3) ** 2
    return car(10 + 5 * time, y)


def test_leaving_the_lane_counts_once_per_excursion() -> None:
    drive = list(scenes(6, drift))
    assert kinds(drive) == ["off_lane", "off_lane"]
    assert kinds([replace(view, ego=replace(view.ego, lane="")) for view in drive]) == ["off_lane", "off_lane"]


def test_the_way_through_the_junction_and_between_two_lanes_is_on_the_road() -> None:
    assert kinds(list(scenes(20, through(start=50)))) == []

    def changing(time: float) -> VehicleState:
        y = min(time, 1.0) * WIDTH
        return car(20 + 5 * time, y, "in_0" if y < WIDTH / 2 else "in_1")

    assert kinds(list(scenes(3, changing))) == []


@pytest.mark.parametrize(("x", "lane"), [(96.0, ":J_0_0"), (124.0, ":J_0_0"), (104.0, "in_0"), (116.0, "out_0")])
def test_near_the_end_of_a_lane_the_next_one_is_on_the_road_too(x: float, lane: str) -> None:
    assert kinds([scene(0.0, car(x, lane=lane))]) == []


def test_on_a_way_that_crosses_the_one_the_simulator_names_it_is_on_the_road() -> None:
    assert kinds([scene(0.0, car(104, lane=":J_3_0"))]) == []


def test_beside_the_way_through_the_junction_is_off_the_road() -> None:
    aside = Pose(115.0, 8.0, 0.0)
    assert kinds([scene(0.0, replace(car(110), pose=aside, lane=":J_0_0"))]) == ["off_lane"]


def test_a_jump_is_noted_and_a_fast_drive_is_none() -> None:
    drive = list(scenes(4, cruising(car(10))))
    jumped = [
        replace(view, ego=replace(view.ego, pose=Pose(view.ego.pose.x + 1.0 * (view.time > 2), 0, 0))) for view in drive
    ]
    assert kinds(drive) == []
    (verdict,) = found(jumped)
    assert verdict.kind is Kind.JUMP
    assert verdict.time == pytest.approx(2.0 + STEP, abs=STEP)


def test_stopping_dead_is_no_jump() -> None:
    assert kinds([scene(0.0, car(10)), scene(STEP, car(10 + 5 * STEP, speed=0.0))]) == []


def test_a_position_that_is_not_a_number_is_a_jump() -> None:
    assert "jump" in kinds([scene(0.0, car(10)), scene(STEP, car(math.nan))])


def test_its_own_maximum_and_the_lane_s_limit_both_bind() -> None:
    maximum = 20 / 3.6 * 1.1
    assert kinds(list(scenes(2, cruising(car(10, speed=maximum - 0.01))))) == []
    assert kinds(list(scenes(2, cruising(car(10, speed=maximum + 0.01))))) == ["speeding"]
    slow_lane = [scene(STEP * i, car(110, -60 + i * STEP * 5.6, "side_0", 5.6, math.pi / 2)) for i in range(10)]
    assert kinds(slow_lane) == ["speeding"]
    turning = [scene(STEP * i, car(110, -5 + i * STEP * 5.6, ":J_4_0", 5.6, math.pi / 2)) for i in range(10)]
    assert kinds(turning) == []
