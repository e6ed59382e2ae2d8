import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from tmpud.errors import RequestError, RunFileError
from tmpud.events import Event, Executed, Finished, Header, to_json
from tmpud.execution.timing import Latency, Stopwatch
from tmpud.recording import LOG, PICTURE, REPLAY, TIMING, read_run, record, record_timing
from tmpud.symbols import Action, State, Transition

STEP = Transition(State("a_0/0", 0), Action.FORWARD, State("a_0/1", 0))
EVENTS: tuple[Event, ...] = (
    Header(0.0, {"tmpud": "0"}, {"name": "Straße"}, {"seed": 7}),
    Executed(1.0, STEP, "done", True, 50.0),
    Finished(1.0, "SUCCESS", "", 50.0, 1.0, 0, {"collisions": 0}),
)


def recorded(folder: Path, events: tuple[Event, ...] = EVENTS) -> Path:
    assert tuple(record(iter(events), folder)) == events
    return folder


def test_what_is_recorded_can_be_read_back(tmp_path: Path) -> None:
    assert tuple(read_run(recorded(tmp_path / "run"))) == EVENTS


def test_the_same_events_give_the_same_bytes_in_another_folder(tmp_path: Path) -> None:
    one, other = recorded(tmp_path / "one"), recorded(tmp_path / "other")
    assert (one / LOG).read_bytes() == (other / LOG).read_bytes()


def test_what_was_written_stays_where_a_run_breaks_off(tmp_path: Path) -> None:
    def broken() -> Iterator[Event]:
        yield from EVENTS[:2]
        raise RuntimeError("the simulator died")

    with pytest.raises(RuntimeError):
        list(record(broken(), tmp_path / "run"))
    assert tuple(read_run(tmp_path / "run")) == EVENTS[:2]


def test_what_was_written_stays_where_nobody_listens_any_more(tmp_path: Path) -> None:
    listening = record(iter(EVENTS), tmp_path / "run")
    next(listening)
    listening.close()  # type: ignore[attr-defined]
    assert tuple(read_run(tmp_path / "run")) == EVENTS[:1]


def test_a_run_that_never_began_leaves_an_earlier_one_alone(tmp_path: Path) -> None:
    def refused() -> Iterator[Event]:
        raise RequestError("no such lane")
        yield

    folder = recorded(tmp_path / "run")
    with pytest.raises(RequestError):
        list(record(refused(), folder))
    assert tuple(read_run(folder)) == EVENTS
    with pytest.raises(RequestError):
        list(record(refused(), tmp_path / "new"))
    assert not (tmp_path / "new").exists()


def test_nothing_made_of_an_earlier_run_stays_beside_a_new_log(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    for name in (TIMING, PICTURE, REPLAY, "notes.txt"):
        (folder / name).write_text("of the first run")
    recorded(folder)
    assert sorted(file.name for file in folder.iterdir()) == sorted([LOG, "notes.txt"])


def test_a_folder_of_other_files_is_left_as_it_is(tmp_path: Path) -> None:
    folder = tmp_path / "atlas"
    folder.mkdir()
    (folder / PICTURE).write_text("somebody's map")
    with pytest.raises(RequestError, match="atlas: there are other files and no run"):
        list(record(iter(EVENTS), folder))
    assert [(file.name, file.read_text()) for file in folder.iterdir()] == [(PICTURE, "somebody's map")]


@pytest.mark.parametrize("name", ["Run", "run 1", "-run", ".run", "r" * 65, "ru\nn", "läuft", "..."])
def test_a_bad_run_name_is_refused_before_anything_is_written(tmp_path: Path, name: str) -> None:
    with pytest.raises(RequestError, match="is no name for a run"):
        list(record(iter(EVENTS), tmp_path / name))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["run", "7", "tmpud-7.b_2", "r" * 64])
def test_a_good_run_name_is_taken(tmp_path: Path, name: str) -> None:
    recorded(tmp_path / name)


def test_a_run_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RunFileError, match=r"none.run\.jsonl\.gz: no such run"):
        list(read_run(tmp_path / "none"))


def test_a_log_named_instead_of_its_folder_is_told_apart(tmp_path: Path) -> None:
    recorded(tmp_path / "run")
    with pytest.raises(RunFileError, match=r"named by its folder, .*/run$"):
        list(read_run(tmp_path / "run" / LOG))


LINES = [json.dumps(to_json(event)) for event in EVENTS]


@pytest.mark.parametrize(
    "bad", ["{", "[]", "null", "{}", '{"event": "Frame", "time": 0}', LINES[1][:-5], '{"event": "Header"} x', "\x00"]
)
@pytest.mark.parametrize("number", [1, 2, 3])
def test_a_damaged_line_is_named_and_those_before_it_are_read(tmp_path: Path, bad: str, number: int) -> None:
    lines = [*LINES[: number - 1], bad, *LINES[number:]]
    (tmp_path / LOG).write_bytes(gzip.compress("\n".join(lines).encode()))
    reading = read_run(tmp_path)
    assert [next(reading) for _ in range(number - 1)] == list(EVENTS[: number - 1])
    with pytest.raises(RunFileError, match=rf"run\.jsonl\.gz:{number}: "):
        next(reading)


def test_a_damaged_file_ends_in_an_error_or_reads_as_before(tmp_path: Path) -> None:
    whole = (recorded(tmp_path / "run") / LOG).read_bytes()
    refused = 0
    for i in range(len(whole)):
        for damaged in (whole[:i], whole[:i] + bytes([whole[i] ^ 0x41]) + whole[i + 1 :]):
            (tmp_path / LOG).write_bytes(damaged)
            try:
                assert tuple(read_run(tmp_path)) == EVENTS
            except RunFileError:
                refused += 1
    assert refused > 1.8 * len(whole)


def test_latencies_are_written_apart_from_the_events(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    before = (folder / LOG).read_bytes()
    record_timing(Stopwatch([Latency("plan", 1.23456), Latency("estimate", 2.0)]), folder)
    assert [json.loads(line) for line in (folder / TIMING).read_text().splitlines()] == [
        {"kind": "plan", "ms": 1.235},
        {"kind": "estimate", "ms": 2.0},
    ]
    assert (folder / LOG).read_bytes() == before
