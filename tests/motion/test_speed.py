import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.judging.roads import WIDTH, crossroads
from tmpud.dynamics import EGO
from tmpud.geometry import Pose
from tmpud.motion import speed
from tmpud.motion.path import Cross, Follow
from tmpud.motion.route import Route, build_route
from tmpud.motion.speed import LOOK_AHEAD, Obstacle, acceleration, follow, leader
from tmpud.scene import Scene, Vehicles, VehicleState

DT = 0.05
ROADS = crossroads()
WAY = ROADS.outgoing("in_0")[0]


def straight() -> Route:
    """Return the route along in_0, through the junction and along out_0."""
    lanes = ROADS.lanes
    moves = (Follow(lanes["in_0"], 0.0, 100.0), Cross(WAY), Follow(lanes["out_0"], 0.0, 100.0))
    return build_route(ROADS, moves, ())


ROUTE = straight()


def stops_behind(speed: float, gap: float, leader_speed: float = 0.0, stop: bool = False) -> tuple[float, float]:
    """Drive up to something ahead by the speed planner; return the least gap and the last speed."""
    station, ahead, least = 20.0, 20.0 + gap, gap
    for _ in range(round(60 / DT)):
        ahead += leader_speed * DT
        room = ahead - station
        obstacles, line = ([], room) if stop else ([Obstacle(room, leader_speed)], None)
        wish = acceleration(ROUTE, min(station, 90.0), speed, obstacles, line)
        new_speed = max(speed + max(wish, -EGO.max_braking) * DT, 0.0)
        station += (speed + new_speed) / 2 * DT
        speed = new_speed
        least = min(least, ahead - station)
    return least, speed


@given(st.floats(0.0, 20 / 3.6), st.floats(0.3, 80.0))
def test_it_never_hits_a_standing_leader_behind_which_it_could_brake(speed: float, gap: float) -> None:
    assume(gap > speed**2 / (2 * EGO.max_braking) + speed * DT + 0.2)
    least, end = stops_behind(speed, gap)
    assert least > 0.0
    assert end < 0.1


@given(st.floats(0.0, 20 / 3.6), st.floats(3.0, 60.0))
def test_it_stops_before_a_line_at_which_it_could_brake(speed: float, distance: float) -> None:
    assume(distance > speed**2 / (2 * 4.0) + 1.0)
    least, end = stops_behind(speed, distance, stop=True)
    assert least > 0.0
    assert end < 0.1


@given(st.floats(0.0, 20 / 3.6), st.floats(5.0, 40.0), st.floats(1.0, 5.0))
def test_behind_a_moving_leader_it_comes_to_its_speed_with_room(speed: float, gap: float, ahead: float) -> None:
    least, end = stops_behind(speed, gap, ahead)
    assert least > 0.5
    assert end == pytest.approx(ahead, abs=0.3)


@given(st.floats(0.0, 8.0), st.floats(0.2, 80.0), st.floats(0.0, 8.0), st.floats(0.0, 10.0))
def test_less_room_or_a_slower_leader_never_make_it_faster(speed: float, gap: float, ahead: float, more: float) -> None:
    here = follow(speed, 5.5, Obstacle(gap, ahead), 2.0)
    assert math.isfinite(here)
    assert follow(speed, 5.5, Obstacle(gap + more, ahead), 2.0) >= here - 1e-9
    assert follow(speed, 5.5, Obstacle(gap, ahead + more), 2.0) >= here - 1e-9


def test_alone_it_drives_at_the_limit() -> None:
    speed, wish = 0.0, 0.0
    for _ in range(400):
        wish = acceleration(ROUTE, 20.0, speed, [], None)
        speed += wish * DT
    assert speed == pytest.approx(20 / 3.6, abs=0.05)
    assert acceleration(ROUTE, 20.0, 9.0, [], None) == -4.0


# leader() ----------------------------------------------------------------------------------------------------------


def car(x: float, y: float = 0.0, heading: float = 0.0, speed: float = 3.0, z: float = 0.0) -> VehicleState:
    return VehicleState(f"{x:g},{y:g}", Pose(x, y, heading), "", z=z, speed=speed)


def followed(*others: VehicleState, x: float = 20.0) -> Obstacle | None:
    ego = VehicleState("ego", Pose(x, 0.0, 0.0), "in_0", speed=5.0)
    scene = Scene(0.0, ego, Vehicles.of(list(others)), {})
    return leader(scene, ROUTE, x)


def test_the_nearest_car_ahead_in_the_lane_is_followed() -> None:
    found = followed(car(60.0, speed=1.0), car(40.0, speed=3.0))
    assert found is not None
    assert found.gap == pytest.approx(20.0 - 4.7, abs=0.05)
    assert found.speed == pytest.approx(3.0)


@pytest.mark.parametrize(
    "other",
    [
        car(10.0),
        car(40.0, WIDTH),
        car(40.0, -WIDTH),
        car(40.0, 2.2),
        car(40.0, z=6.0),
        car(95.0),
        car(40.0, 4.5, heading=math.pi / 2),
    ],
    ids=["behind", "left lane", "right lane", "beside", "bridge", "far", "crossing beyond"],
)
def test_who_is_not_in_the_way_is_not_followed(other: VehicleState) -> None:
    assert followed(other) is None


@pytest.mark.parametrize(
    ("other", "gap"),
    [
        (car(40.0, 1.9), 20.0 - 4.7),
        (car(40.0, -1.9), 20.0 - 4.7),
        (car(40.0, 2.5, heading=math.pi / 2), 20.0 - 4.7 / 2 - 1.9 / 2),
        (car(110.0, 0.0), 10.0 - 4.7),
    ],
    ids=["reaching in from the left", "from the right", "across the lane", "behind the junction"],
)
def test_who_reaches_into_the_way_is_followed(other: VehicleState, gap: float) -> None:
    found = followed(other, x=100.0) if other.pose.x > 100 else followed(other)
    assert found is not None
    assert found.gap == pytest.approx(gap, abs=0.3)


def test_only_the_speed_along_the_route_counts() -> None:
    across = followed(car(40.0, 0.0, heading=math.pi / 2, speed=4.0))
    oncoming = followed(car(40.0, 0.0, heading=math.pi, speed=4.0))
    assert across is not None
    assert oncoming is not None
    assert across.speed == pytest.approx(0.0, abs=1e-9)
    assert oncoming.speed == 0.0


@given(st.floats(-3.0, 3.0), st.floats(5.0, 45.0))
def test_left_and_right_are_the_same(y: float, ahead: float) -> None:
    left, right = followed(car(20.0 + ahead, y)), followed(car(20.0 + ahead, -y))
    assert (left is None) == (right is None)
    if left is not None and right is not None:
        assert left.gap == pytest.approx(right.gap)


def test_a_car_beyond_the_look_ahead_is_not_followed_on_the_straight_line_that_continues_the_way() -> None:
    route = turn_left()
    x, y, heading = route.pose_at(LOOK_AHEAD + EGO.length)
    beyond = VehicleState("far", Pose(x + 9.0 * math.cos(heading), y + 9.0 * math.sin(heading), heading), "")
    assert leader(Scene(0.0, EGO_AT_START, Vehicles.of([beyond]), {}), route, 0.0) is None


def test_the_first_look_by_circles_leaves_out_nobody_who_is_in_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    rng, route = np.random.default_rng(1), turn_left()
    scenes = [Scene(0.0, EGO_AT_START, Vehicles.of([beside(route, rng)]), {}) for _ in range(2000)]
    found = [leader(scene, route, 0.0) for scene in scenes]
    monkeypatch.setattr(speed, "_near", lambda scene, *_: np.arange(len(scene.others)))
    assert found == [leader(scene, route, 0.0) for scene in scenes]
    assert 200 < sum(one is None for one in found) < 1800


def test_an_empty_road_has_no_leader() -> None:
    assert followed() is None


# Routes ------------------------------------------------------------------------------------------------------------


def turn_left() -> Route:
    way = next(way for way in ROADS.outgoing("in_1") if way.to_lane == "north_0")
    lanes = ROADS.lanes
    return build_route(ROADS, (Follow(lanes["in_1"], 50.0, 100.0), Cross(way), Follow(lanes["north_0"], 0.0, 50.0)), ())


EGO_AT_START = VehicleState("ego", turn_left().pose_at(0.0), "in_1", speed=5.0)


def beside(route: Route, rng: np.random.Generator) -> VehicleState:
    """Return a vehicle of any size and heading near the route."""
    x, y, _ = route.pose_at(rng.uniform(0.0, LOOK_AHEAD))
    pose = Pose(x + rng.uniform(-8, 8), y + rng.uniform(-8, 8), rng.uniform(-math.pi, math.pi))
    return VehicleState("other", pose, "", length=rng.uniform(1.0, 15.0), width=rng.uniform(0.5, 2.5))


@pytest.mark.parametrize("route", [straight(), turn_left()], ids=["straight", "left"])
def test_the_speed_limit_keeps_lateral_acceleration_and_braking_within_reach(route: Route) -> None:
    assert (route.speed_limit**2 * np.abs(route.curvature)).max() <= EGO.max_lateral_acceleration + 1e-9
    assert route.speed_limit.max() <= EGO.max_speed + 1e-9
    braking = (route.speed_limit[:-1] ** 2 - route.speed_limit[1:] ** 2) / (2 * 0.5)
    assert braking.max() <= 2.0 + 1e-6


def test_a_slower_road_is_obeyed_from_where_it_begins() -> None:
    route = turn_left()
    assert float(route.speed_limit[route.index(route.end - 20.0)]) <= 5.0 + 1e-9


def test_a_route_knows_its_stop_line_and_its_end() -> None:
    (gate,) = ROUTE.gates
    assert [gate.station, gate.exit] == pytest.approx([100.0, 120.0])
    assert ROADS.connections[gate.connection] == WAY
    assert ROUTE.end == pytest.approx(220.0)
    assert ROUTE.line_crossing is None


@given(st.floats(1.0, 215.0), st.floats(-2.0, 2.0))
def test_a_point_beside_the_route_is_found_again(station: float, offset: float) -> None:
    x, y, heading = ROUTE.pose_at(station)
    there = ROUTE.project(x - offset * math.sin(heading), y + offset * math.cos(heading))
    assert there == pytest.approx((station, offset), abs=0.02)


def test_a_limit_of_the_vehicle_below_the_roads_counts() -> None:
    slow = build_route(ROADS, (Follow(ROADS.lanes["in_0"], 0.0, 90.0),), (), replace(EGO, max_speed=2.0))
    assert slow.speed_limit.max() == 2.0
