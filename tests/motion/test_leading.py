import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.judging.roads import WIDTH
from tests.motion.routes import ROUTE, turn_left
from tmpud.dynamics import EGO
from tmpud.geometry import Pose
from tmpud.motion import leading
from tmpud.motion.leading import LOOK_AHEAD, Obstacle, leader
from tmpud.motion.route import Route
from tmpud.scene import Scene, Vehicles, VehicleState

EGO_AT_START = VehicleState("ego", turn_left().pose_at(0.0), "in_1", speed=5.0)


def beside(route: Route, rng: np.random.Generator) -> VehicleState:
    """Return a vehicle of any size and heading near the route."""
    x, y, _ = route.pose_at(rng.uniform(0.0, LOOK_AHEAD))
    pose = Pose(x + rng.uniform(-8, 8), y + rng.uniform(-8, 8), rng.uniform(-math.pi, math.pi))
    size = rng.uniform(1.0, 15.0), rng.uniform(0.5, 2.5)
    return VehicleState("other", pose, "", 0.0, rng.uniform(0.0, 14.0), length=size[0], width=size[1])


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


def test_in_a_turn_the_way_where_the_vehicle_is_counts() -> None:
    route = turn_left()
    here, there = route.pose_at(30.0), route.pose_at(66.0)
    assert abs(there.heading - here.heading) > 1.0
    ego, turned = VehicleState("ego", here, ""), VehicleState("a", there, "", speed=6.0)
    found = leader(Scene(0.0, ego, Vehicles.of([turned]), {}), route, 30.0)
    assert found is not None
    assert found.speed == pytest.approx(6.0, abs=0.1)


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


@pytest.mark.parametrize("route", [ROUTE, turn_left()], ids=["straight", "left"])
def test_the_first_look_leaves_out_nobody_who_is_in_the_way(route: Route, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    ego = VehicleState("ego", route.pose_at(0.0), "", speed=5.0)
    scenes = [Scene(0.0, ego, Vehicles.of([beside(route, rng) for _ in range(3)]), {}) for _ in range(3000)]
    found = [leader(scene, route, 0.0) for scene in scenes]
    monkeypatch.setattr(leading, "_near", lambda scene, *_: [(0, box) for box in scene.others.bodies])
    assert found == [leader(scene, route, 0.0) for scene in scenes]
    assert 300 < sum(one is None for one in found) < 2700


def test_an_empty_road_has_no_leader() -> None:
    assert followed() is None
