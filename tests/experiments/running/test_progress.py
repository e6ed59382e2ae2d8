from __future__ import annotations

import time

import pytest

from tmpud.experiments.running.progress import Progress


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def test_it_says_how_far_how_fast_and_how_long(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    bar = Progress("table1", 1000)
    clock[0] += 20.0
    bar.step(100)
    assert capsys.readouterr().err.split() == ["table1", "100/1,000", "5.0/s", "3:00", "left"]


def test_what_was_done_earlier_is_no_speed_of_now(clock: list[float], capsys: pytest.CaptureFixture[str]) -> None:
    bar = Progress("table1", 1000)
    bar.skip(900)
    clock[0] += 20.0
    bar.step(10, "heavy")
    assert capsys.readouterr().err.split() == ["table1", "910/1,000", "30.0/min", "3:00", "left", "heavy"]


def test_it_is_quiet_where_nobody_watches_but_for_the_end(
    clock: list[float], capsys: pytest.CaptureFixture[str]
) -> None:
    bar = Progress("table1", 3)
    for _ in bar.over(range(3)):
        clock[0] += 1.0
    assert capsys.readouterr().err.count("\n") == 1
