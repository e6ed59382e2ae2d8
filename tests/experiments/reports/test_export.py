import csv
import json
from pathlib import Path

import pytest

from tmpud.errors import RequestError
from tmpud.experiments.reports.export import write_rows
from tmpud.experiments.statistics.rows import TrialRow

ROWS = [
    TrialRow(condition="heavy, \"x\"", algorithm="tmpud", trial=1, status="SUCCESS", distance=1.5, unsafe=False,
             details={"merges": [0.25, None], "replans": 2}),
    TrialRow(condition="heavy", algorithm="no-com", trial=1, status="SIM_HANG", distance=0.0, unsafe=False,
             details={"message": "10 s"}),
]  # fmt: skip


def test_csv_holds_every_trial_and_detail(tmp_path: Path) -> None:
    write_rows(ROWS, tmp_path / "t.csv")
    with (tmp_path / "t.csv").open(newline="") as file:
        first, second = csv.DictReader(file)
    assert (first["condition"], first["distance"], first["merges"]) == ('heavy, "x"', "1.5", "[0.25, null]")
    assert (second["status"], second["message"], second["replans"]) == ("SIM_HANG", "10 s", "")


def test_json_and_parquet_hold_the_same(tmp_path: Path) -> None:
    polars = pytest.importorskip("polars")
    write_rows(ROWS, tmp_path / "t.json")
    write_rows(ROWS, tmp_path / "t.parquet")
    rows = json.loads((tmp_path / "t.json").read_text())
    assert polars.read_parquet(tmp_path / "t.parquet").to_dicts() == rows
    assert [row["algorithm"] for row in rows] == ["tmpud", "no-com"]


def test_no_trials_give_a_file_with_a_heading(tmp_path: Path) -> None:
    write_rows([], tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text().startswith("condition,algorithm,trial")


def test_another_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RequestError, match=r"\.csv, \.json, \.parquet"):
        write_rows(ROWS, tmp_path / "t.xls")
