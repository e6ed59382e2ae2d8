from dataclasses import replace

import pytest

from tmpud.errors import RequestError
from tmpud.experiments.reports.comparison import compare_runs
from tmpud.experiments.statistics.rows import TrialRow

RUN = [
    TrialRow(condition="heavy", algorithm="tmpud", trial=n, status="SUCCESS", distance=400.0 + n % 7, unsafe=n % 4 == 0)
    for n in range(60)
]


def test_a_run_does_not_differ_from_itself() -> None:
    (row,) = compare_runs(RUN, RUN).rows
    assert row[:3] == ("heavy", "tmpud", "60")
    assert row[3] == "0.0 [0.0, 0.0]"
    assert row[4].startswith("0.0 [")
    assert row[5] == "60"


def test_a_planted_difference_is_found_with_its_sign() -> None:
    other = [replace(row, distance=row.distance + 10 + row.trial % 3, unsafe=False) for row in RUN]
    (row,) = compare_runs(RUN, other).rows
    low, high = map(float, row[3].partition("[")[2].rstrip("]").split(","))
    assert 10 < low <= 11 <= high < 12
    assert row[4].startswith("-250.0 [")
    assert row[5] == "0"


def test_trials_of_one_run_only_are_not_compared() -> None:
    (row,) = compare_runs(RUN, RUN[:40]).rows
    assert row[2] == "40"


def test_runs_without_anything_in_common_are_refused() -> None:
    with pytest.raises(RequestError, match="in common"):
        compare_runs(RUN, [replace(row, condition="normal") for row in RUN])
