import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.events import Frame
from tmpud.geometry import Pose
from tmpud.viewer.film.traffic import JUMP, Recording, between, pose

FRAMES = (
    Frame(1.0, (0, 0, 3100, 500), ("a", "b"), ((1000, 0, 0, 900), (0, 0, 0, 0)), {"light": "r"}),
    Frame(1.1, (50, 10, -3100, 500), ("c", "a"), ((0, 0, 0, 0), (1100, 0, 0, 900)), {"light": "g"}),
)


def test_at_a_frame_everything_is_where_the_frame_has_it() -> None:
    for frame in FRAMES:
        traffic = Recording(FRAMES).at(frame.time)
        assert traffic.ego == pytest.approx(pose(frame.ego))
        assert dict(traffic.others) == dict(zip(frame.ids, map(pose, frame.others), strict=True))
        assert traffic.signals == frame.signals


def test_between_two_frames_it_is_on_the_way_and_turns_the_short_way_round() -> None:
    traffic = Recording(FRAMES).at(1.05)
    assert (traffic.ego.x, traffic.ego.y) == pytest.approx((0.25, 0.05))
    assert abs(traffic.ego.heading) > 3.1
    assert traffic.others["a"].x == pytest.approx(10.5)
    assert set(traffic.others) == {"a", "b"}


def test_before_the_first_and_after_the_last_frame_it_is_theirs() -> None:
    assert Recording(FRAMES).at(-5.0).ego == pytest.approx(pose(FRAMES[0].ego))
    assert Recording(FRAMES).at(99.0).ego == pytest.approx(pose(FRAMES[1].ego))


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0, 1))
def test_a_vehicle_that_was_put_elsewhere_does_not_race_there(x: float, y: float, share: float) -> None:
    found = between(Pose(0.0, 0.0, 0.0), Pose(x, y, 0.0), share)
    driven = math.hypot(x, y) <= JUMP
    assert (found.x, found.y) == (pytest.approx((share * x, share * y), abs=1e-9) if driven else (0.0, 0.0))
