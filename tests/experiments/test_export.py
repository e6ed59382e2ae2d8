import csv
import json
from pathlib import Path

from tests.experiments.planted import planted, row
from tmpud.experiments.export import write_csv


def test_rows_come_back_from_the_file(tmp_path: Path) -> None:
    rows = planted(20, seed=1)
    write_csv(rows, tmp_path / "trials.csv")
    with (tmp_path / "trials.csv").open(newline="") as file:
        back = list(csv.DictReader(file))
    assert len(back) == len(rows)
    for line, trial in zip(back, rows, strict=True):
        assert (line["algorithm"], int(line["trial"]), line["status"]) == (trial.algorithm, trial.trial, trial.status)
        assert float(line["distance"]) == trial.distance
        assert line["unsafe"] == ("true" if trial.unsafe else "false")
        assert json.loads(line["details.collisions"]) == trial.details["collisions"]


def test_names_with_commas_quotes_and_line_ends_and_missing_details_are_kept_apart(tmp_path: Path) -> None:
    names = ('a,"b"', "two\nlines", "half a pair \ud800")
    write_csv([row(name, i, details={str(i): [1, None]}) for i, name in enumerate(names)], tmp_path / "trials.csv")
    with (tmp_path / "trials.csv").open(newline="", encoding="utf-8") as file:
        back = list(csv.DictReader(file))
    assert [line["algorithm"] for line in back] == [*names[:2], "half a pair ?"]
    assert [(line["details.0"], line["details.1"]) for line in back] == [("[1, null]", ""), ("", "[1, null]"), ("", "")]


def test_no_rows_are_a_header(tmp_path: Path) -> None:
    write_csv([], tmp_path / "trials.csv")
    assert (tmp_path / "trials.csv").read_text().strip() == "condition,algorithm,trial,batch,status,distance,unsafe"
