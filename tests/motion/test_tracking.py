import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.motion.routes import ROUTE
from tmpud.dynamics import EGO, step, within_limits
from tmpud.geometry import Pose
from tmpud.motion.tracking import PID, Tracker
from tmpud.scene import VehicleState

DT = 0.05


def test_a_proportional_controller_is_proportional_up_to_its_limit() -> None:
    pid = PID(2.0, 0.0, 0.0, 1.0)
    assert [pid(error, DT) for error in (0.1, -0.2, 5.0, -5.0)] == [0.2, -0.4, 1.0, -1.0]


def test_the_integral_takes_away_a_lasting_error() -> None:
    pid, value = PID(0.5, 1.0, 0.0, 10.0), 0.0
    for _ in range(2000):
        value += (pid(1.0 - value, DT) - 0.3) * DT
    assert value == pytest.approx(1.0, abs=1e-3)


def test_the_integral_does_not_wind_up_while_the_output_is_saturated() -> None:
    pid = PID(1.0, 1.0, 0.0, 1.0)
    for _ in range(1000):
        assert pid(10.0, DT) == 1.0
    assert pid(-0.5, DT) < 0.0


def test_the_derivative_does_not_kick_at_the_first_error() -> None:
    pid = PID(0.0, 0.0, 1.0, 10.0)
    assert pid(5.0, DT) == 0.0
    assert pid(5.1, DT) == pytest.approx(0.1 / DT)


@given(st.floats(-1.0, 1.0), st.floats(-0.3, 0.3), st.floats(0.0, 5.5), st.floats(-10.0, 10.0), st.floats(10.0, 180.0))
def test_every_command_is_within_the_vehicles_limits(
    offset: float, heading: float, speed: float, wish: float, station: float
) -> None:
    ego = VehicleState("ego", Pose(station, offset, heading), "in_0", speed=speed)
    assert within_limits(Tracker(ROUTE).control(ego, station, offset, wish, DT), EGO)


@given(st.floats(-1.0, 1.0), st.floats(-0.2, 0.2))
def test_beside_the_path_it_comes_back_to_it(offset: float, heading: float) -> None:
    ego, tracker = VehicleState("ego", Pose(10.0, offset, heading), "in_0", speed=5.0), Tracker(ROUTE)
    for _ in range(round(25 / DT)):
        station, beside = ROUTE.project(ego.pose.x, ego.pose.y)
        ego = step(ego, tracker.control(ego, station, beside, 0.0, DT), DT)
    assert abs(ego.pose.y) < 0.1
    assert abs(ego.pose.heading) < 0.05
    assert ego.speed == pytest.approx(5.0, abs=0.05)


def test_the_steering_turns_towards_the_path() -> None:
    for offset in (-1.0, 1.0):
        ego = VehicleState("ego", Pose(20.0, offset, 0.0), "in_0", speed=5.0)
        assert math.copysign(1.0, Tracker(ROUTE).control(ego, 20.0, offset, 0.0, DT).steering) == -offset
