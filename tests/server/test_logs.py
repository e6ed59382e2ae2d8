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


def test_another_run_in_its_place_is_read_anew(tmp_path: Path) -> None:
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
