from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from benchmarks.harness import DisagreementError, Entry, Result, SkipError, field_of, race


def entry(name: str, answer: Callable[[int], float], log: list[str] | None = None, **options: float) -> Entry[int]:
    def pose(case: int) -> Callable[[], float]:
        def work() -> float:
            if log is not None:
                log.append(f"{name}{case}")
            return answer(case)

        return work

    return Entry(name, pose, **options)  # type: ignore[arg-type]


def test_entries_take_turns_case_by_case_and_the_warm_up_is_not_timed() -> None:
    log: list[str] = []
    times = race([entry(name, float, log) for name in "AB"], [1, 2], warmup=1)
    assert log == ["A1", "B1", "A1", "B1", "A2", "B2"]
    assert {name: len(each) for name, each in times.items()} == {"A": 2, "B": 2}


def test_every_case_is_timed_where_the_warm_up_is_longer_than_all_cases() -> None:
    assert len(race([entry("A", float)], [1, 2], warmup=5)["A"]) == 2


def test_a_long_turn_repeats_quick_work_and_the_mean_counts() -> None:
    log: list[str] = []
    (spent,) = race([entry("A", float, log)], [1], warmup=0, turn=0.002)["A"]
    assert len(log) > 1
    assert spent * len(log) >= 0.002


@pytest.mark.parametrize("wrong", [2.5, 0.0, math.nan, math.inf])
def test_an_answer_that_differs_is_an_error_that_names_who_and_what(wrong: float) -> None:
    with pytest.raises(DisagreementError, match=rf"B answers \[{wrong}\], A \[2.0\], to 2"):
        race([entry("A", float), entry("B", lambda case: wrong if case == 2 else float(case))], [1, 2, 3])


def test_a_wrong_answer_among_many_is_an_error() -> None:
    def row(*values: float) -> Callable[[int], Callable[[], tuple[float, ...]]]:
        return lambda case: lambda: values  # noqa: ARG005

    for wrong in ((1.0, 2.5, 3.0), (1.0, 2.0)):
        with pytest.raises(DisagreementError):
            race([Entry("A", row(1.0, 2.0, 3.0)), Entry("B", row(*wrong), 0.1)], [0])


def test_answers_may_differ_by_the_tolerance_and_a_floor_answers_nothing() -> None:
    close = entry("close", lambda case: case + 0.4, tolerance=0.5)
    floor = entry("floor", lambda case: -1.0, compared=False)  # noqa: ARG005
    assert set(race([entry("A", float), close, floor], [1])) == {"A", "close", "floor"}


def test_who_cannot_take_part_is_left_out_with_the_reason() -> None:
    def missing() -> Entry[int]:
        raise SkipError("no compiler")

    entries, skipped = field_of({"A": lambda: entry("A", float), "B": missing})
    assert [one.name for one in entries] == ["A"]
    assert skipped == {"B": "no compiler"}


def test_ratios_compare_rounds_with_each_other() -> None:
    result = Result("title", "base", {"base": [1.0, 2.0, 4.0], "other": [2.0, 2.0, 2.0]})
    assert result.ratios("other") == [2.0, 1.0, 0.5]


def test_the_slow_end_is_a_p99_where_there_are_rounds_enough_for_one() -> None:
    many = [float(number) for number in range(1, 1001)]
    assert Result("title", "A", {"A": many}).slow("A") == pytest.approx(990, abs=1)
    assert Result("title", "A", {"A": many[:10]}).slow("A") == 10
