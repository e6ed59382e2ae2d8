from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from tmpud.geometry import Point, Polyline
from tmpud.roads.sumo_links import joined

START = Polyline([(0.0, 0.0), (10.0, 0.0)])
END = Polyline([(30.0, 20.0), (30.0, 40.0)])
POINTS = st.lists(st.tuples(st.floats(5, 35), st.floats(-5, 25)), max_size=6)


@given(POINTS)
def test_a_path_runs_from_the_end_of_one_lane_to_the_start_of_the_next(inner: list[Point]) -> None:
    path = joined(START, inner, END)
    assert path.points[0] == (10.0, 0.0)
    assert path.points[-1] == (30.0, 20.0)
    assert set(path.points[1:-1]) <= set(inner)


@given(POINTS)
def test_no_inner_step_of_a_path_is_short_and_backward(inner: list[Point]) -> None:
    points = joined(START, inner, END).points
    for a, b, c in zip(points, points[1:-1], points[2:-1], strict=False):
        back = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < -1e-9
        assert not (back and min(math.dist(a, b), math.dist(b, c)) < 1.0)


def test_rounding_at_the_joints_leaves_no_trace() -> None:
    path = joined(START, [(9.99, 0.0), (20.0, 0.0), (30.0, 20.02)], END)
    assert path.points == ((10.0, 0.0), (20.0, 0.0), (30.0, 20.0))


def test_lanes_that_touch_get_a_path_of_a_tenth_of_a_metre_along_the_second() -> None:
    path = joined(START, [], Polyline([(10.0, 0.0), (20.0, 0.0)]))
    assert path.points == ((10.0, 0.0), (10.1, 0.0))
