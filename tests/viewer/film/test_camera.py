import math
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from tmpud.viewer.film.camera import camera
from tmpud.viewer.film.stage import SPAN

FASTEST = 15.0  # [m/s]
turns = st.lists(st.tuples(st.floats(0, FASTEST), st.floats(-0.1, 0.1)), min_size=2, max_size=400)


@given(turns)
def test_the_ego_never_leaves_the_picture_and_the_camera_never_jumps(drive: list[tuple[float, float]]) -> None:
    x = y = heading = 0.0
    path = []
    for speed, turn in drive:
        heading += turn
        x, y = x + 0.1 * speed * math.cos(heading), y + 0.1 * speed * math.sin(heading)
        path.append((x, y))
    times = [0.1 * number for number in range(len(path))]
    looking = camera(times, path, *SPAN)
    centres = [looking.at(time) for time in times]
    for (px, py), (cx, cy) in zip(path, centres, strict=True):
        assert abs(px - cx) < SPAN[0] / 2
        assert abs(py - cy) < SPAN[1] / 2
    for (ax, ay), (bx, by) in pairwise(centres):
        assert math.hypot(ax - bx, ay - by) < 0.15 * SPAN[0]


def test_the_camera_stands_still_while_the_ego_goes_a_short_way() -> None:
    path = [(0.1 * number, 0.0) for number in range(100)]
    looking = camera([0.1 * number for number in range(100)], path, *SPAN)
    assert {looking.at(0.1 * number) for number in range(100)} == {(4.95, 0.0)}
