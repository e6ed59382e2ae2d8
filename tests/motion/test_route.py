import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.motion.routes import ROADS, ROUTE, WAY, straight, turn_left
from tmpud.dynamics import EGO
from tmpud.geometry import Polyline
from tmpud.motion.path import Follow
from tmpud.motion.route import COMFORTABLE_BRAKING, SPACING, Route, _braked, _points_at, build_route


@pytest.mark.parametrize("route", [straight(), turn_left()], ids=["straight", "left"])
def test_points_are_at_most_the_spacing_apart(route: Route) -> None:
    assert np.hypot(np.diff(route.x), np.diff(route.y)).max() <= SPACING + 1e-9


@pytest.mark.parametrize("route", [straight(), turn_left()], ids=["straight", "left"])
def test_the_speed_limit_keeps_lateral_acceleration_and_braking_within_reach(route: Route) -> None:
    assert (route.speed_limit**2 * np.abs(route.curvature)).max() <= EGO.max_lateral_acceleration + 1e-9
    assert route.speed_limit.max() <= EGO.max_speed + 1e-9
    braking = (route.speed_limit[:-1] ** 2 - route.speed_limit[1:] ** 2) / (2 * 0.5)
    assert braking.max() <= 2.0 + 1e-6


def test_speeds_fall_towards_a_slower_place_by_comfortable_braking_and_no_sooner() -> None:
    allowed = np.random.default_rng(1).uniform(0.5, 14.0, 400)
    expected = allowed.copy()
    for i in range(len(expected) - 2, -1, -1):
        expected[i] = min(expected[i], math.sqrt(expected[i + 1] ** 2 + 2 * COMFORTABLE_BRAKING * SPACING))
    assert _braked(allowed) == pytest.approx(expected, rel=1e-12)


@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=2, max_size=8, unique=True))
def test_many_points_of_a_line_are_those_of_its_poses(points: list[tuple[float, float]]) -> None:
    try:
        line = Polyline(points)
    except ValueError:
        return
    stations = np.array([0.0, *np.linspace(0.0, line.length, 7), *line.stations])
    assert _points_at(line, stations).tolist() == [list(line.pose_at(s)[:2]) for s in stations.tolist()]


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


@given(st.floats(1.0, 215.0), st.floats(-7.0, 7.0), st.floats(-7.0, 7.0))
def test_the_nearest_point_is_found_without_looking_at_all(station: float, dx: float, dy: float) -> None:
    route = turn_left()
    x, y, _ = route.pose_at(min(station, route.length))
    x, y = x + dx, y + dy
    nearest = int(np.hypot(x - route.x, y - route.y).argmin())
    along, across = route.project(x, y)
    assert abs(along - nearest * SPACING) <= np.hypot(dx, dy) + SPACING
    assert math.hypot(along - nearest * SPACING, across) == pytest.approx(
        math.hypot(x - route.x[nearest], y - route.y[nearest])
    )
