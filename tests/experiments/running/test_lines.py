from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.experiments.running.lines import Contents, counted, decode, encode, read
from tmpud.experiments.running.tasks import DONE, ERROR, TOOL_FAULTS, Record

RESULTS = st.dictionaries(
    st.text(),
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
        lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    ),
)


def record(key: str = "a", task: str = "1", status: str = DONE, **result: float) -> Record:
    return Record(key=key, digest=task, status=status, result=result)


@given(key=st.text(), result=RESULTS)
def test_a_record_is_one_line_and_comes_back(key: str, result: dict[str, object]) -> None:
    written = Record(key=key, digest="1", status=ERROR, result=result)
    line = encode(written)
    assert line.count(b"\n") == 1
    assert decode(line) == written


@given(place=st.integers(0, 10_000), byte=st.integers(0, 255))
def test_no_other_byte_is_accepted(place: int, byte: int) -> None:
    line = bytearray(encode(record(distance=12.5)))
    place %= len(line)
    if line[place] == byte:
        return
    line[place] = byte
    with pytest.raises(ValueError, match=r"line|checksum"):
        decode(bytes(line))


def test_what_json_does_not_hold_is_not_written() -> None:
    with pytest.raises(ValueError, match="JSON"):
        encode(record(distance=float("nan")))


def test_a_file_that_is_not_there_is_empty(tmp_path: Path) -> None:
    assert read(tmp_path / "none") == Contents((), (), 0)


def test_a_line_that_was_cut_off_is_outside_the_size(tmp_path: Path) -> None:
    file = tmp_path / "results"
    file.write_bytes(encode(record()) + encode(record("b"))[:-1])
    contents = read(file)
    assert contents.size == len(encode(record()))
    assert contents.damages == (f"{file}:2: cut off; dropped",)


@given(st.lists(st.tuples(st.sampled_from([DONE, *TOOL_FAULTS]), st.integers(0, 2)), min_size=1))
def test_the_first_result_counts_and_else_the_last_fault(ends: list[tuple[str, int]]) -> None:
    records = [record(status=status, take=take) for status, take in ends]
    done = [one for one in records if one.status == DONE]
    found, refused = counted(Path("file"), Contents(tuple(enumerate(records, 1)), (), 0), {"a": "1"})
    expected = done[0] if done else records[-1]
    assert found == {"a": expected}
    after = records[records.index(expected) :] if done else []
    assert len(refused) == sum(one != expected for one in after), "a fault before a result is no damage"


def test_the_first_result_of_a_key_counts(tmp_path: Path) -> None:
    contents = Contents(((1, record(distance=1)), (2, record(distance=1)), (3, record(distance=2))), (), 0)
    records, refused = counted(tmp_path, contents)
    assert records == {"a": record(distance=1)}
    assert refused == [f"{tmp_path}:3: a second, other result of 'a'; the first counts"]


def test_a_record_of_another_task_does_not_count(tmp_path: Path) -> None:
    contents = Contents(((1, record(task="old")), (2, record(task="new")), (3, record("b"))), (), 0)
    records, refused = counted(tmp_path, contents, {"a": "new"})
    assert records == {"a": record(task="new")}
    assert [text.partition(" ")[0] for text in refused] == [f"{tmp_path}:1:", f"{tmp_path}:3:"]
    records, refused = counted(tmp_path, contents)
    assert records == {"a": record(task="old"), "b": record("b")}
    assert len(refused) == 1
