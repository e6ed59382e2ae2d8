import math

import numpy as np

from tests.experiments.planted import planted, row
from tmpud.experiments.reports.table import (
    Table,
    as_text,
    comparison,
    findings_table,
    interval,
    statuses_table,
    verdicts,
)
from tmpud.experiments.statistics.cells import Cell, cells
from tmpud.experiments.statistics.claims import Finding, judge
from tmpud.experiments.statistics.intervals import Estimate
from tmpud.experiments.statistics.pairing import pair
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, TABLE1
from tmpud.experiments.statistics.rows import TrialRow


def analysed(rows: list[TrialRow]) -> tuple[list[Cell], list[Finding]]:
    rng = np.random.default_rng(0)
    pairs = pair(rows, tuple(TABLE1), ALGORITHMS)
    found = [cell for paired in pairs for cell in cells(paired, rows, rng, resamples=500)]
    return found, [finding for paired in pairs for finding in judge(paired, rng, resamples=500)]


BOTH = [*planted(100, seed=1), *planted(100, seed=2, condition="heavy")]


def test_the_table_has_the_papers_layout_and_its_numbers_beside_ours() -> None:
    found, _ = analysed(BOTH)
    table = comparison("Table I", found, TABLE1)
    assert [line[0] for line in table.rows] == ["normal"] * 5 + ["heavy"] * 5
    assert [line[1] for line in table.rows[:5]] == ["TMPUD", "Th(0.5)", "Th(0.3)", "Th(0.1)", "No-com"]
    heavy = table.rows[-1]
    assert (heavy[3], heavy[6]) == ("426", "270")  # the paper's No-com: 54 of 200
    assert heavy[2].startswith(f"{found[-1].distance.value:.1f} [")
    assert heavy[4] == f"{found[-1].unsafe} of 100"


def test_an_algorithm_or_condition_that_the_paper_has_not_is_shown_without_its_numbers() -> None:
    found, _ = analysed([row("mine", 0), row("tmpud", 0), row("tmpud", 0, condition="rush hour")])
    table = comparison("", found, TABLE1)
    assert [(line[0], line[1], line[3]) for line in table.rows] == [
        ("normal", "TMPUD", "514"),
        ("normal", "mine", "-"),
        ("rush hour", "TMPUD", "-"),
    ]


def test_tool_faults_are_named_beside_the_table_and_in_the_statuses() -> None:
    found, _ = analysed([row("tmpud", 0), row("tmpud", 1, status="SIM_CRASH"), row("tmpud", 2, status="NO_PLAN")])
    table = comparison("", found, TABLE1)
    assert table.rows[0][4] == "0 of 2"
    assert any("normal, tmpud: 1" in note for note in table.notes)
    statuses = statuses_table(found)
    assert statuses.columns[3:] == ("NO_PLAN", "SUCCESS", "SIM_CRASH (tool fault)")
    assert statuses.rows == (("normal", "TMPUD", "3", "1", "1", "1"),)


def test_each_finding_has_its_line_and_each_part_of_the_claim_its_verdict() -> None:
    _, found = analysed(BOTH)
    assert len(findings_table(found).rows) == len(found) == 30
    lines = verdicts(found)
    assert [line[:3] for line in lines] == ["(a)", "(a)", "(b)", "(b)", "(c)", "(c)"]
    assert lines[0] == "(a) No-com is the shortest and the least safe - normal: holds"


def test_text_is_aligned_and_names_a_condition_once() -> None:
    found, _ = analysed(BOTH)
    lines = as_text(comparison("Table I", found, TABLE1)).split("\n")
    at = lines[2].index("algorithm")
    assert {line[at - 1] for line in lines[2:14]} == {" "}
    assert sum(line.startswith("normal ") for line in lines[4:14]) == 1


def test_a_terminal_gets_no_control_characters() -> None:
    assert "\x1b" not in as_text(Table("\x1b[2J", ("a\x1b[31m",), (("b\x07\n",),), ("\x1b[0m",)))


def test_intervals_are_written_with_one_decimal_and_unknown_ends_as_such() -> None:
    assert interval(Estimate(1.25, -0.04, 3, 9)) == "1.2 [0.0, 3.0]"
    assert interval(Estimate(1.0, -math.inf, math.inf, 1)) == "1.0 [?, ?]"
    assert interval(Estimate(math.nan, 0, 1000, 0)) == "-"
    assert interval(Estimate(-0.0087, -0.0206, -0.003, 103)) == "-0.009 [-0.021, -0.003]"
