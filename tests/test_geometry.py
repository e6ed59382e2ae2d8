import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.geometry import Point, Polyline, wrap_angle


@given(st.floats(-100, 100))
def test_wrapped_angles_keep_their_direction_and_lie_in_the_half_open_turn(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.isclose(math.cos(wrapped), math.cos(angle), abs_tol=1e-9)
    assert math.isclose(math.sin(wrapped), math.sin(angle), abs_tol=1e-9)


@given(st.floats(0.5, 15), st.floats(-1, 1))
def test_projecting_a_point_beside_a_curve_returns_its_station_and_offset(station: float, offset: float) -> None:
    line = Polyline([(0, 0), (10, 0), (20, 0)])
    x, y, heading = line.pose_at(station, offset)
    assert heading == 0
    assert line.project(x, y) == pytest.approx((station, offset), abs=1e-9)


POINT = st.tuples(st.floats(-50, 50), st.floats(-50, 50))


@given(st.lists(POINT, min_size=2, max_size=6, unique_by=lambda p: (round(p[0]), round(p[1]))), POINT)
def test_the_least_distance_of_a_point_is_never_more_than_its_distance(curve: list[Point], point: Point) -> None:
    line = Polyline(curve)
    assert line.least_distance(*point) <= abs(line.project(*point)[1]) + 1e-9


def test_the_least_distance_of_a_point_before_or_beyond_a_straight_line_is_its_distance() -> None:
    line = Polyline([(0, 0), (5, 0), (10, 0)])
    assert line.least_distance(-3, 0) == pytest.approx(3)
    assert line.least_distance(14, 0) == pytest.approx(4)


def test_the_parts_of_a_polyline_add_up_to_its_length() -> None:
    line = Polyline([(0, 0), (3, 4), (3, 4), (3, 10)])
    assert line.length == 11
    assert line.between(2, 7).length + line.between(7, 11).length == pytest.approx(9)
    assert line.resampled(0.5).length == pytest.approx(11, abs=0.2)


def test_a_polyline_of_one_point_is_refused() -> None:
    with pytest.raises(ValueError, match="two distinct points"):
        Polyline([(1, 1), (1, 1)])
