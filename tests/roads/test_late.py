import json
import pickle

import pytest

from tmpud.roads.late import BLOCK, Late, Named

SIZES = (0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK)


def made(count: int, *, packed: bool) -> Late[str]:
    rows = [[number] for number in range(count)]
    blocks = [rows[at : at + BLOCK] for at in range(0, count, BLOCK)]
    lines = [json.dumps(["numbers", block]).encode() for block in blocks]
    return Late(lines if packed else blocks, count, str)


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("count", SIZES)
def test_it_is_a_sequence_like_any_other(count: int, packed: bool) -> None:
    plain = tuple(map(str, range(count)))
    assert made(count, packed=packed) == plain
    assert plain == made(count, packed=packed)
    assert tuple(made(count, packed=packed)) == plain
    late = made(count, packed=packed)
    for place in (-1, 0, count // 2, count - 1, -count):
        if count:
            assert late[place] == plain[place]
    for place in (count, -count - 1, 10 * BLOCK):
        with pytest.raises(IndexError):
            late[place]
    assert tuple(late[-3:]) == plain[-3:]
    assert tuple(late[:: BLOCK // 2]) == plain[:: BLOCK // 2]
    assert late != (*plain, "one more")
    assert late != 5


def test_it_is_made_a_block_at_a_time_and_once() -> None:
    asked = []

    def note(number: int) -> object:
        asked.append(number)
        return object()

    late = Late([[[n] for n in range(BLOCK)], [[n] for n in range(BLOCK, 2 * BLOCK)]], 2 * BLOCK, note)
    assert late[BLOCK] is late[BLOCK]
    assert asked == list(range(BLOCK, 2 * BLOCK))


def test_names_are_known_before_anything_is_made() -> None:
    late = made(BLOCK + 1, packed=True)
    named = Named([f"n{number}" for number in range(BLOCK + 1)], late)
    assert (len(named), "n3" in named, "n" in named, [*named][-1]) == (BLOCK + 1, True, False, f"n{BLOCK}")
    assert named["n3"] == "3"
    assert named == {f"n{number}": str(number) for number in range(BLOCK + 1)}
    with pytest.raises(KeyError):
        named["n"]


def test_it_can_be_handed_to_another_process() -> None:
    late = made(BLOCK + 5, packed=True)
    assert late[0] == "0"
    assert pickle.loads(pickle.dumps(late)) == late  # noqa: S301
