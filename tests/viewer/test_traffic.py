from collections.abc import Sequence
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.viewer.made_runs import frame
from tmpud.events import Frame
from tmpud.viewer.traffic import columns, sound

whole = st.integers(-(2**31), 2**31)
row = st.tuples(whole, whole, whole, whole)
scene = st.dictionaries(st.sampled_from("abcd"), row, max_size=4)


def undone(twice: Sequence[int]) -> list[int]:
    return list(accumulate(accumulate(twice)))


@given(st.lists(st.tuples(row, scene, st.sampled_from(["G", "r"])), min_size=1, max_size=12))
def test_the_columns_hold_every_frame_again(
    seen: list[tuple[tuple[int, int, int, int], dict[str, tuple[int, int, int, int]], str]],
) -> None:
    frames = [
        Frame(number / 10, ego, tuple(cars), tuple(cars.values()), {"light": letters})
        for number, (ego, cars, letters) in enumerate(seen)
    ]
    packed = columns(frames)
    assert list(accumulate(packed["times"])) == [number * 100 for number in range(len(seen))]
    x, y, heading, speed = packed["ego"]
    found = zip(undone(x), undone(y), accumulate(heading), accumulate(speed), strict=True)
    assert list(found) == [ego for ego, _, _ in seen]
    cars = {
        (first + i, name): place
        for name, *stretches in packed["cars"]
        for first, x, y, heading in stretches
        for i, place in enumerate(zip(undone(x), undone(y), accumulate(heading), strict=True))
    }
    assert cars == {(number, name): place[:3] for number, (_, now, _) in enumerate(seen) for name, place in now.items()}
    switched = packed["lights"]["light"]
    for number, (_, _, letters) in enumerate(seen):
        assert [shown for since, shown in switched if since <= number][-1] == letters


@pytest.mark.parametrize(
    "damaged",
    [
        Frame(1.0, (1, 2, 3), (), (), {}),  # type: ignore[arg-type]
        Frame(1.0, (1, 2, 3, 4.5), (), (), {}),  # type: ignore[arg-type]
        Frame(1.0, (1, 2, 3, 2**60), (), (), {}),
        Frame(1.0, (1, 2, 3, 4), ("a",), (), {}),
        Frame(1.0, (1, 2, 3, 4), ("a", "a"), ((1, 2, 3, 4),) * 2, {}),
        Frame(1.0, (1, 2, 3, 4), (5,), ((1, 2, 3, 4),), {}),  # type: ignore[arg-type]
        Frame(1.0, (1, 2, 3, 4), (), (), {"light": 5}),  # type: ignore[dict-item]
        Frame(-1.0, (1, 2, 3, 4), (), (), {}),
    ],
)
def test_a_damaged_frame_is_not_sound(damaged: Frame) -> None:
    assert sound(frame(0))
    assert not sound(damaged)
