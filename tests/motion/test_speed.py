import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.motion.routes import ROUTE
from tmpud.dynamics import EGO
from tmpud.motion.leading import Obstacle
from tmpud.motion.speed import acceleration, follow

DT = 0.05


def stops_behind(speed: float, gap: float, leader_speed: float = 0.0, stop: bool = False) -> tuple[float, float]:
    """Drive up to something ahead by the speed planner; return the least gap and the last speed."""
    station, ahead, least = 20.0, 20.0 + gap, gap
    for _ in range(round(120 / DT)):
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
