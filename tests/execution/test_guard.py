import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.dynamics import EGO, within_limits
from tmpud.execution.guard import Guard
from tmpud.scene import Control

BRAKE = Control(-EGO.max_braking, 0.0)
ODD = (math.nan, math.inf, -math.inf, 1e308, -1e308, 3.0001, -8.0001, 0.6001, -0.6001, 0.0, -0.0, 5e-324)


@given(st.floats(-EGO.max_braking, EGO.max_acceleration), st.floats(-EGO.max_steering, EGO.max_steering))
def test_what_the_vehicle_can_carry_out_passes_unchanged(acceleration: float, steering: float) -> None:
    guard, command = Guard(), Control(acceleration, steering)
    assert guard.check(command) is command
    assert guard.refused is None


def test_of_ten_thousand_injected_commands_none_beyond_the_limits_leaves_the_guard() -> None:
    rng, refused = random.Random(1), 0
    for _ in range(10_000):
        value = [rng.choice(ODD) if rng.random() < 0.5 else rng.uniform(-20, 20) for _ in range(2)]
        command = None if rng.random() < 0.1 else Control(*value)
        guard = Guard()
        passed = guard.check(command)
        assert math.isfinite(passed.acceleration)
        assert math.isfinite(passed.steering)
        assert -8.0 - 1e-9 <= passed.acceleration <= 3.0 + 1e-9
        assert abs(passed.steering) <= 0.6 + 1e-9
        if guard.refused is None:
            assert passed is command
        else:
            assert passed == BRAKE
            refused += 1
    assert refused > 5000


def test_it_says_which_command_it_refused_first() -> None:
    guard = Guard()
    guard.check(None)
    guard.check(Control(math.nan, 0.0))
    assert guard.refused == "no command"
    guard = Guard()
    guard.check(Control(0.0, 0.0))
    guard.check(Control(math.nan, 0.25))
    assert guard.refused is not None
    assert "nan" in guard.refused
    assert "0.25" in guard.refused


@pytest.mark.parametrize("command", [None, Control(0.0, 9.0)])
def test_it_brakes_with_the_wheels_straight(command: Control | None) -> None:
    assert Guard().check(command) == BRAKE
    assert within_limits(BRAKE)


def test_after_a_refused_command_it_brakes_for_good() -> None:
    guard = Guard()
    assert guard.check(Control(1.0, 0.0)) == Control(1.0, 0.0)
    assert guard.check(None) == BRAKE
    assert guard.check(Control(1.0, 0.0)) == BRAKE
