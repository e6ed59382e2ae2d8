"""A log that grows is read on, whatever it was cut into."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.viewer.made_runs import events, header, recorded
from tmpud.events import Finished, Header
from tmpud.recording import LOG
from tmpud.server.logs import Log


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return (recorded(tmp_path_factory.mktemp("log") / "run") / LOG).read_bytes()


@given(st.lists(st.integers(0, 3000), max_size=8))
def test_in_whatever_pieces_a_log_comes_it_ends_up_the_same(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, cuts: list[int]
) -> None:
    file = tmp_path_factory.mktemp("growing") / LOG
    log, seen = Log(file), 0
    for end in [*sorted(min(cut, len(data)) for cut in cuts), len(data)]:
        file.write_bytes(data[:end])
        assert log.read_on(inf)
        assert seen <= log.lines
        seen = log.lines
    assert (log.lines, log.damage) == (len(events()), "")
    assert isinstance(log.first, Header)
    assert isinstance(log.last, Finished)


@pytest.mark.parametrize("end", [400, None], ids=["that was not whole", "that was whole"])
@pytest.mark.parametrize("removed", [False, True])
def test_another_run_in_the_place_of_one(tmp_path: Path, data: bytes, end: int | None, removed: bool) -> None:
    others = [header(seed=seed, start="x" * length) for seed, length in ((2, 1), (3, 9000))]
    for number, other in enumerate([*others, None]):
        whole = data if other is None else (recorded(tmp_path / f"other{number}", [other]) / LOG).read_bytes()
        file = tmp_path / LOG
        file.write_bytes((recorded(tmp_path / "first", [header(seed=1)]) / LOG).read_bytes()[:end])
        log = Log(file)
        log.read_on(inf)
        if removed:
            file.rename(tmp_path / "old")
        file.write_bytes(whole)
        log.read_on(inf)
        anew = Log(file)
        anew.read_on(inf)
        assert (log.lines, log.first, log.last, log.damage) == (anew.lines, anew.first, anew.last, "")
        assert isinstance(log.first, Header)
        assert other is None or log.first.mission["seed"] == other.mission["seed"]


def test_a_shorter_run_in_its_place_is_read_anew(tmp_path: Path) -> None:
    log = Log(recorded(tmp_path / "run") / LOG)
    log.read_on(inf)
    recorded(tmp_path / "run", [header()])
    log.read_on(inf)
    assert (log.lines, log.damage) == (1, "")
    assert isinstance(log.last, Header)


def test_a_damage_is_told_and_what_came_before_it_stays(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / LOG
    file.write_bytes(b"no gzip at all")
    log = Log(file)
    log.read_on(inf)
    assert log.damage.startswith("everything after line 0")
    file.write_bytes(data)
    log.read_on(inf)
    assert (log.lines, log.damage) == (len(events()), "")


def test_reading_stops_when_time_is_up_and_goes_on_later(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / LOG
    file.write_bytes(data)
    log = Log(file)
    assert not log.read_on(-inf)
    assert log.read_on(inf)
    assert log.lines == len(events())
