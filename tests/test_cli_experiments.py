import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tmpud.experiments.trials.sweep import read_sweep

SWEEP = """
traffic: {few: 15}
missions: {from: park2e_0, to: high3n_1}
algorithms: [tmpud, no-com]
seeds: [1, 2]
"""


def tmpud(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tmpud", *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def _heed_interrupts() -> None:
    """Undo what a shell does to its background jobs."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which a sweep was driven."""
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "sweep.yaml").write_text(SWEEP)
    done = tmpud(folder, "sweep", "sweep.yaml", "--out", "run", "--json")
    assert done.returncode == 0, done.stderr
    (folder / "first.json").write_text(done.stdout)
    return folder


def test_a_sweep_drives_all_trials_and_writes_its_report(swept: Path) -> None:
    found = json.loads((swept / "first.json").read_text())
    assert (found["done"], found["complete"]) == (4, True)
    assert [(cell["condition"], cell["algorithm"], cell["trials"]) for cell in found["cells"]] == [
        ("few", "tmpud", 2),
        ("few", "no-com", 2),
    ]
    report = (swept / "run" / "report.md").read_text()
    assert found["results_hash"] in report
    assert "tmpud sweep sweep.yaml" in report
    assert {"report.html", "figure.svg", "figure.png", "trials.csv"} <= {
        file.name for file in (swept / "run").iterdir()
    }


def test_the_same_command_again_drives_nothing_and_says_the_same(swept: Path) -> None:
    before = (swept / "run" / "results.jsonl").read_bytes()
    again = tmpud(swept, "sweep", "sweep.yaml", "--out", "run", "--json", "--jobs", "1")
    assert again.stdout == (swept / "first.json").read_text()
    assert (swept / "run" / "results.jsonl").read_bytes() == before


def test_another_sweep_is_refused_the_folder_in_one_line(swept: Path) -> None:
    (swept / "other.yaml").write_text(SWEEP.replace("[1, 2]", "[3]"))
    refused = tmpud(swept, "sweep", "other.yaml", "--out", "run")
    assert refused.returncode == 2
    assert "option seeds" in refused.stderr.splitlines()[-1]
    assert "Traceback" not in refused.stderr


def test_results_are_printed_exported_and_compared(swept: Path) -> None:
    shown = tmpud(swept, "results", "run", "--export", "trials.parquet", "--compare", "run", "--json")
    assert shown.returncode == 0, shown.stderr
    rows = json.loads(shown.stdout)
    assert [row["distance [m]"].partition(" ")[0] for row in rows] == ["0.0", "0.0"]
    assert (swept / "trials.parquet").exists()
    assert "4 tasks done" in tmpud(swept, "results", "run").stdout


@pytest.mark.parametrize("name", ["nowhere", "empty", "file"])
def test_what_is_no_folder_of_results_is_refused_in_one_line(tmp_path: Path, name: str) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "file").touch()
    refused = tmpud(tmp_path, "results", name)
    assert refused.returncode == 4
    assert refused.stderr == f"tmpud: {name}: no results: there is no manifest.json\n"


def test_the_file_that_help_shows_can_be_swept(tmp_path: Path) -> None:
    shown = tmpud(tmp_path, "sweep", "--help").stdout.partition("left out:\n")[2]
    (tmp_path / "shown.yaml").write_text(shown)
    grid = read_sweep(tmp_path / "shown.yaml")
    assert (len(grid.missions), grid.traffic, len(grid.seeds)) == (3, {"normal": 120, "heavy": 200}, 20)


def test_the_figure_is_drawn_from_a_few_trials(tmp_path: Path) -> None:
    done = tmpud(tmp_path, "paper", "figure4", "--trials", "8", "--batches", "2", "--out", "run", "--json")
    assert done.returncode == 0, done.stderr
    assert {cell["trials"] for cell in json.loads(done.stdout)["cells"]} == {8}
    assert "clingo" in (tmp_path / "run" / "report.md").read_text()


def test_an_interrupted_table_goes_on_where_it_stopped(tmp_path: Path) -> None:
    (tmp_path / "sweep.yaml").write_text(SWEEP.replace("[1, 2]", "[1, 2, 3, 4]"))
    command = [sys.executable, "-m", "tmpud", "sweep", "sweep.yaml", "--out", "run", "--jobs", "2"]
    running = subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=_heed_interrupts
    )
    results = tmp_path / "run" / "results.jsonl"
    until = time.monotonic() + 120
    while not (results.exists() and results.stat().st_size) and time.monotonic() < until:
        time.sleep(0.05)
    os.kill(running.pid, signal.SIGINT)
    _, said = running.communicate()
    assert running.returncode == 130
    assert said.splitlines()[-1].startswith("tmpud: interrupted")
    kept = results.read_bytes()
    assert kept
    assert tmpud(tmp_path, "sweep", "sweep.yaml", "--out", "run").returncode == 0
    assert results.read_bytes().startswith(kept)
    assert len(results.read_bytes().splitlines()) == 8
