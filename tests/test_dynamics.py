import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.dynamics import EGO, step, within_limits
from tmpud.errors import InvalidStateError
from tmpud.geometry import Pose
from tmpud.scene import Control, VehicleState

DT = 0.05
START = VehicleState("ego", Pose(0.0, 0.0, 0.0), "a_0", speed=5.0)

accelerations = st.floats(-EGO.max_braking, EGO.max_acceleration)
steerings = st.floats(-EGO.max_steering, EGO.max_steering)


def driven(state: VehicleState, control: Control, seconds: float) -> VehicleState:
    for _ in range(round(seconds / DT)):
        state = step(state, control, DT)
    return state


@given(steerings.filter(lambda angle: abs(angle) > 1e-3), st.floats(0.5, 5.5), st.floats(0.5, 8.0))
def test_at_constant_steering_the_rear_axle_drives_the_circle_of_the_bicycle(
    steering: float, speed: float, seconds: float
) -> None:
    end = driven(replace(START, speed=speed), Control(0.0, steering), seconds)
    radius, half = EGO.wheelbase / math.tan(steering), EGO.wheelbase / 2
    turned = speed * round(seconds / DT) * DT / radius
    rear_x, rear_y = -half + radius * math.sin(turned), radius * (1 - math.cos(turned))
    assert end.pose.x == pytest.approx(rear_x + half * math.cos(turned), abs=1e-6)
    assert end.pose.y == pytest.approx(rear_y + half * math.sin(turned), abs=1e-6)
    assert math.cos(end.pose.heading - turned) == pytest.approx(1.0, abs=1e-9)
    assert end.yaw_rate == pytest.approx(speed / radius)


@given(accelerations, st.floats(0.0, 5.5))
def test_straight_on_it_moves_by_the_law_of_uniform_acceleration(acceleration: float, speed: float) -> None:
    end = step(replace(START, speed=speed), Control(acceleration, 0.0), DT)
    assert end.pose.y == end.pose.heading == end.yaw_rate == 0.0
    assert end.speed == max(speed + acceleration * DT, 0.0)
    assert end.pose.x == pytest.approx((speed + end.speed) / 2 * DT)
    assert end.speed == pytest.approx(speed + end.acceleration * DT)


@given(accelerations, steerings, st.floats(0.0, 5.5))
def test_left_and_right_are_mirrored(acceleration: float, steering: float, speed: float) -> None:
    left = step(replace(START, speed=speed), Control(acceleration, steering), DT)
    right = step(replace(START, speed=speed), Control(acceleration, -steering), DT)
    assert (left.pose.x, left.pose.y, left.yaw_rate) == pytest.approx((right.pose.x, -right.pose.y, -right.yaw_rate))


def test_it_brakes_to_a_standstill_and_not_backwards() -> None:
    end = driven(START, Control(-8.0, 0.3), 3.0)
    assert end.speed == end.yaw_rate == 0.0
    assert driven(end, Control(-8.0, 0.3), 1.0).pose == end.pose


@pytest.mark.parametrize("acceleration", [-8.0, 3.0])
@pytest.mark.parametrize("steering", [-0.6, 0.6])
def test_commands_at_the_limits_are_carried_out(acceleration: float, steering: float) -> None:
    assert within_limits(Control(acceleration, steering))
    step(START, Control(acceleration, steering), DT)


@pytest.mark.parametrize(
    "control",
    [
        Control(math.nan, 0.0),
        Control(0.0, math.nan),
        Control(math.inf, 0.0),
        Control(-math.inf, 0.0),
        Control(0.0, math.inf),
        Control(3.01, 0.0),
        Control(-8.01, 0.0),
        Control(0.0, 0.61),
        Control(0.0, -0.61),
    ],
)
def test_a_command_beyond_the_limits_is_an_invalid_state(control: Control) -> None:
    assert not within_limits(control)
    with pytest.raises(InvalidStateError, match="not within the vehicle's limits"):
        step(START, control, DT)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("field", ["x", "y", "heading", "speed"])
def test_a_state_that_is_not_finite_is_an_invalid_state(field: str, value: float) -> None:
    broken = (
        replace(START, speed=value) if field == "speed" else replace(START, pose=START.pose._replace(**{field: value}))
    )
    with pytest.raises(InvalidStateError):
        step(broken, Control(0.0, 0.1), DT)
