import json
import math
from pathlib import Path

import numpy as np
import pytest

from tmpud.experiments.calibration.predictions import (
    BETAS,
    Merges,
    base_rate,
    gather,
    qualities,
    quality_table,
    to_json,
)
from tmpud.experiments.calibration.report import calibration_report
from tmpud.experiments.calibration.scores import BASELINES
from tmpud.experiments.reports.document import write_report
from tmpud.experiments.reports.table import as_text
from tmpud.experiments.running.tasks import DONE, ERROR, Record


def record(key: str, rows: list[tuple[float, float | None, bool]], status: str = DONE) -> Record:
    merges = [{"scores": {"tmpud": safe, "gap": gap}, "unsafe": unsafe} for safe, gap, unsafe in rows]
    return Record(key=key, digest="", status=status, result={"status": "SUCCESS", "merges": merges})


def planted(n: int, seed: int = 0) -> Merges:
    """Return merges whose "tmpud" tells the truth, whose "gap" does so on another scale, and a "paper" that guesses."""
    rng = np.random.default_rng(seed)
    safe = rng.random(n)
    scores = {"tmpud": safe, "paper": rng.random(n), "gap": np.where(safe > 0.9, np.inf, safe * 40 - 5)}
    return Merges("local", scores, rng.random(n) > safe, np.arange(n))


def test_merges_are_grouped_by_drive_and_local_ones_stand_alone() -> None:
    rows = [(0.5, 1.0, True), (1.0, None, False)]
    local, town = gather([record("town/120/2", rows), record("local/c/1", rows), record("town/120/1", rows)])
    assert (local.source, town.source) == ("local", "town")
    assert len(set(local.groups.tolist())) == 2
    assert town.groups.tolist() == [0, 0, 1, 1]
    assert town.unsafe.tolist() == [True, False, True, False]
    assert town.scores["gap"].tolist() == [1.0, math.inf, 1.0, math.inf]


def test_tool_faults_and_drives_without_merges_are_left_out() -> None:
    (town,) = gather([record("town/1", [(0.5, 1.0, True)], ERROR), record("town/2", [(0.2, 1.0, True)])])
    assert town.scores["tmpud"].tolist() == [0.2]
    assert gather([record("town/3", [])]) == ()


def test_a_planted_truth_is_found_and_a_guess_is_seen_to_be_one() -> None:
    merges = planted(600)
    tmpud, paper, gap = qualities(merges)
    assert tmpud.area.low < 5 / 6 < tmpud.area.high  # of a right score that is uniform
    assert paper.area.low < 0.5 < paper.area.high
    assert paper.lead is not None
    assert paper.lead.high < 0
    assert tmpud.brier == pytest.approx(1 / 6, abs=0.04)  # mean of s (1 - s)
    assert gap.recalibrated == pytest.approx(tmpud.brier, abs=0.04)
    assert paper.recalibrated == pytest.approx(base_rate(merges), abs=0.04)


def test_baselines_have_no_probability_of_their_own() -> None:
    for quality in qualities(planted(100)):
        is_baseline = quality.score in BASELINES
        assert (quality.brier is None) == is_baseline
        assert len(quality.refusals) == (0 if is_baseline else len(BETAS))
        assert (not quality.reliability) == is_baseline


def test_qualities_are_the_same_each_time() -> None:
    assert qualities(planted(80)) == qualities(planted(80))


def test_the_table_names_every_score_and_how_many_merges_stand_behind_it() -> None:
    merges = planted(100)
    text = as_text(quality_table(merges, qualities(merges)))
    assert all(name in text for name in merges.scores)
    assert f"100 merges (100 independent), {merges.unsafe.sum()} unsafe" in text


def test_without_unsafe_merges_the_table_still_stands() -> None:
    merges = planted(30)
    calm = Merges("town", merges.scores, np.zeros(30, dtype=np.bool_), merges.groups)
    assert "0 unsafe" in as_text(quality_table(calm, qualities(calm)))


def test_numbers_are_kept_as_json_with_none_for_what_is_not_known() -> None:
    merges = planted(30)
    calm = Merges("town", merges.scores, np.zeros(30, dtype=np.bool_), merges.groups)
    (kept,) = json.loads(json.dumps(to_json([(calm, qualities(calm))]), allow_nan=False))
    assert (kept["source"], kept["n"], kept["unsafe"]) == ("town", 30, 0)
    assert kept["scores"][0]["area"]["value"] is None


def test_the_report_has_a_table_for_each_source_and_equal_findings_give_equal_files(tmp_path: Path) -> None:
    merges = planted(60)
    found = [(merges, qualities(merges))] * 2
    for name in ("a", "b"):
        write_report(tmp_path / name, calibration_report(found, (), "tmpud paper calibration", {}))
    text = (tmp_path / "a" / "report.md").read_text()
    assert text.count("60 merges") == 2
    for file in ("report.html", "calibration.svg"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_a_report_on_nothing_says_so() -> None:
    report = calibration_report([], (), "tmpud paper calibration", {})
    assert report.sections[0].lines == ("No merge was begun.",)
