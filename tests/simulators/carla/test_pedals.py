import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.simulators.carla.pedals import Pedals

DT = 0.05


def driven(command: float, seconds: float, pull: float, brakes: float, speed: float = 0.0) -> tuple[float, float]:
    """Return the speed and the brake of a car whose pedals pull and brake otherwise than expected."""
    pedals, brake = Pedals(DT), 0.0
    for _ in range(round(seconds / DT)):
        throttle, brake = pedals.press(command, speed)
        speed = max(speed + (throttle * pull - brake * brakes) * DT, 0.0)
    return speed, brake


@given(command=st.floats(0.5, 2.0), pull=st.floats(3.5, 7.0))
def test_a_stronger_or_weaker_engine_reaches_about_the_speed_that_was_asked_for(command: float, pull: float) -> None:
    assert driven(command, 2.0, pull, 9.0)[0] == pytest.approx(2.0 * command, rel=0.2)


@given(brakes=st.floats(6.0, 12.0))
def test_a_car_that_was_braked_to_a_stand_is_held(brakes: float) -> None:
    assert driven(-2.0, 5.0, 5.0, brakes, speed=5.0) == (0.0, 1.0)


def test_a_car_that_shall_stand_does_not_creep() -> None:
    assert driven(0.0, 1.0, 5.0, 9.0) == (0.0, 1.0)


@given(command=st.floats(-8.0, 3.0), speed=st.floats(-1.0, 30.0))
def test_pedals_are_within_their_range_and_never_both_pressed(command: float, speed: float) -> None:
    pedals = Pedals(DT)
    for _ in range(5):
        throttle, brake = pedals.press(command, speed)
        assert 0.0 <= throttle <= 1.0
        assert 0.0 <= brake <= 1.0
        assert throttle == 0.0 or brake == 0.0
