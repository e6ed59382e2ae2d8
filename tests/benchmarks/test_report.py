from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from benchmarks.harness import Result
from benchmarks.report import as_json, shown, table

RESULT = Result("a race", "A", {"A": [0.001, 0.002, 0.004], "B": [0.002, 0.002, 0.002]}, {"C": "not here"})


def test_a_table_is_aligned_and_has_medians_ratios_and_who_was_skipped() -> None:
    head, first, second, skipped = table(RESULT).splitlines()
    assert head.split()[-5:] == ["slowest", "x", "A", "each", "round"]
    assert second.split() == ["B", "2", "ms", "2", "ms", "1", "2", "1", "0.5"]
    assert len(head) == len(first) == len(second)
    assert skipped == "C: skipped, not here"


def test_a_p99_is_called_one_only_where_there_are_rounds_enough() -> None:
    assert "p99" not in table(RESULT)
    assert "p99" in table(Result("a race", "A", {"A": [0.001] * 100}))


def test_a_batch_gives_a_throughput() -> None:
    result = Result("a race", "A", {"A": [0.002] * 6}, batch=(500, "shares"))
    head, only = table(result).splitlines()
    assert head.endswith("shares/s")
    assert only.split() == ["A", "2", "ms", "2", "ms", "1", "250,000"]
    (found,) = as_json("safety", {}, [result])["results"]
    assert found["entries"]["A"]["shares_per_s"] == pytest.approx(250000.0)


def test_a_time_is_shown_in_its_unit() -> None:
    assert [shown(seconds) for seconds in (2.5e-6, 0.0123, 4.5)] == ["2.5 us", "12.3 ms", "4.5 s"]


def test_json_says_n_versions_machine_and_each_round() -> None:
    options = {"pairs": 3, "maps": ["m"], "segment_length": math.inf, "json": Path("found.json")}
    found = json.loads(json.dumps(as_json("plan", options, [RESULT]), allow_nan=False))
    assert found["options"] == {"pairs": 3, "maps": ["m"], "segment_length": "inf", "json": "found.json"}
    assert {"cores", "cpu", "python", "load", "date"} <= set(found["machine"])
    assert {"tmpud", "clingo"} <= set(found["versions"])
    (result,) = found["results"]
    assert result["n"] == 3
    assert result["entries"]["B"] == {
        "median_s": 0.002,
        "slow_s": 0.002,
        "ratio": 1.0,
        "each_s": [0.002, 0.002, 0.002],
    }
