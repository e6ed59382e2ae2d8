from __future__ import annotations

import json
from pathlib import Path

import pytest

from tools.verification.figures import ROOT, Figure, keep, none_in, provenance, section, table
from tools.verification.trials import drive, each
from tools.verify import SECTIONS, main

FIGURE = Figure("a thing", 7, "0 of 7 | none", "0", holds=True, seed=1)


def test_a_section_that_is_run_alone_keeps_the_others(tmp_path: Path) -> None:
    keep(tmp_path, "old", section(provenance("python -m tools.verify old"), [FIGURE], 1.0))
    assert main(["estimates", "--cases", "20", "--output", str(tmp_path)]) == 0
    written = json.loads((tmp_path / "verification.json").read_text())
    assert set(written) == {"old", "estimates"}
    assert written["estimates"]["command"] == "python -m tools.verify estimates --cases 20"
    assert {"date", "commit", "versions"} <= set(written["estimates"])


def test_a_missed_target_is_shown_and_gives_exit_code_1(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    missed = Figure("a thing", 7, "3 wrong", "0 wrong", holds=False, seed=1)
    monkeypatch.setitem(SECTIONS, "nets", lambda _: [missed])
    assert main(["nets", "--output", str(tmp_path)]) == 1
    assert "| 3 wrong | 0 wrong | **no** |" in (tmp_path / "verification.md").read_text()


def test_the_plans_section_compares_planners(tmp_path: Path) -> None:
    assert main(["plans", "--graphs", "3", "--output", str(tmp_path)]) == 0
    assert "| 3 | 1 | 0 of 9 (rate below 0.33) mismatches;" in (tmp_path / "verification.md").read_text()


def test_a_section_that_is_not_there_is_refused_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main(["estimates", "plan", "--output", str(tmp_path)])
    assert "no section is called plan; there are plans, estimates" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_no_figure_is_zero_without_its_n() -> None:
    assert none_in(2000) == "0 of 2,000 (rate below 0.0015)"
    assert none_in(2) == "0 of 2"


def test_the_committed_table_is_the_committed_json() -> None:
    file = ROOT / "docs" / "verification.json"
    if not file.exists():
        pytest.skip("nothing was verified yet")
    assert table(json.loads(file.read_text())) == file.with_suffix(".md").read_text()


def test_a_trial_without_a_result_says_why(tmp_path: Path) -> None:
    trial = drive(tmp_path / "run", ["--from", "nowhere", "--to", "random"])
    assert trial.status == "NO RESULT"
    assert "nowhere" in trial.message


def test_work_that_is_interrupted_ends_at_once() -> None:
    def interrupted(item: int) -> int:
        if item == 1:
            raise KeyboardInterrupt
        return item

    with pytest.raises(KeyboardInterrupt):
        list(each(interrupted, range(100)))
