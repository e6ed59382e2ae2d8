from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.geometry import Pose
from tmpud.roads import carla_coordinates as carla

lengths = st.floats(-1e4, 1e4)
boxes = st.tuples(st.floats(-5, 5), st.floats(-5, 5))


@given(lengths, lengths, st.floats(-math.pi, math.pi, exclude_min=True), boxes)
def test_a_pose_comes_back_from_carla_as_it_was(x: float, y: float, heading: float, box: tuple[float, float]) -> None:
    back = carla.to_pose(*carla.from_pose(Pose(x, y, heading), box), box)
    assert math.dist(back[:2], (x, y)) < 1e-8
    assert math.cos(back.heading - heading) > 1 - 1e-12


@given(lengths, lengths, st.floats(-900, 900), boxes)
def test_an_actor_comes_back_where_it_was_up_to_whole_turns(
    x: float, y: float, yaw: float, box: tuple[float, float]
) -> None:
    x1, y1, yaw1 = carla.from_pose(carla.to_pose(x, y, yaw, box), box)
    assert math.dist((x1, y1), (x, y)) < 1e-8
    assert math.remainder(yaw1 - yaw, 360.0) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-900, 900))
def test_headings_are_wrapped_and_turn_against_yaw(yaw: float) -> None:
    heading = carla.to_heading(yaw)
    assert -math.pi < heading <= math.pi
    assert math.cos(heading) == pytest.approx(math.cos(math.radians(yaw)), abs=1e-9)
    assert math.sin(heading) == pytest.approx(-math.sin(math.radians(yaw)), abs=1e-9)


@given(st.floats(-30, 30), st.floats(-900, 900))
def test_whoever_drives_forward_in_carla_drives_along_the_heading(speed: float, yaw: float) -> None:
    velocity = speed * math.cos(math.radians(yaw)), speed * math.sin(math.radians(yaw))
    vx, vy = carla.to_point(*velocity)
    heading = carla.to_heading(yaw)
    assert vx * math.cos(heading) + vy * math.sin(heading) == pytest.approx(speed, abs=1e-9)


def test_what_is_right_in_carla_is_right_for_us() -> None:
    facing_east = carla.to_pose(0.0, 0.0, 0.0)
    right = carla.to_point(0.0, 1.0)  # CARLA's y axis points to the right
    assert right == (0.0, -1.0)
    assert carla.to_heading(90.0) == -math.pi / 2  # turned right
    assert carla.to_yaw_rate(10.0) < 0.0  # turning right
    assert carla.to_steer(0.1, 70.0) < 0.0 < carla.to_steer(-0.1, 70.0)  # steer > 0 is to the right
    assert carla.to_pose(0.0, 0.0, 0.0, box=(1.0, 0.5)) == Pose(1.0, -0.5, facing_east.heading)


@given(st.floats(-1, 1), st.floats(1, 90))
def test_steer_comes_back_and_never_leaves_its_range(steer: float, largest: float) -> None:
    assert carla.to_steer(carla.from_steer(steer, largest), largest) == pytest.approx(steer, abs=1e-12)
    assert abs(carla.to_steer(10 * steer, largest)) <= 1.0


def test_velocities_and_limits_are_in_metres_per_second() -> None:
    assert carla.to_speed(90.0) == 25.0
    assert carla.from_point(*carla.to_point(3.0, 4.0)) == (3.0, 4.0)
