"""The rules that ``docs/rules.md`` shows are kept as it says."""

from __future__ import annotations

import re
from pathlib import Path

from tmpud.planning import Problem
from tmpud.task.rules import OF_PLANS, Predicate

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "rules.md").read_text()


def test_the_example_runs(tmp_path: Path) -> None:
    file = tmp_path / "town.lp"
    file.write_text("".join(line[4:] for line in PAGE.splitlines(keepends=True) if re.match(r"    [%:]", line)))
    words = re.search(r"--from (\S+) --to (\S+) --rules", PAGE)
    assert words is not None
    report = Problem.of("millbrook", words[1], words[2]).with_rules(file).solve()
    lanes = {step.next_state.segment.partition("/")[0] for step in report.plan}
    assert "east2n_0" in lanes
    assert not any(lane.startswith("high3n") for lane in lanes)


def test_every_predicate_that_plans_have_is_explained() -> None:
    told = {Predicate(name, terms.count(",") + 1) for name, terms in re.findall(r"`(\w+)\(([\w,]+)\)`", PAGE)}
    assert told == OF_PLANS
