"""Sections about the paper's experiments: run in full by the command line, their reports kept in ``docs/results``."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tmpud.experiments.kinds import Findings, findings
from tmpud.experiments.reports.document import write_report
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.progress import Progress
from tmpud.experiments.running.store import read_results
from tmpud.experiments.running.tasks import results_hash
from tmpud.experiments.running.workers import Limits
from tmpud.experiments.statistics.claims import PARTS, Verdict, worst
from tmpud.experiments.trials.grid import cells
from tmpud.experiments.trials.table1 import FIRST_SEED, Table1
from tools.verification.figures import ROOT, Figure
from tools.verification.options import Options

KEPT = ROOT / "docs" / "results"
JOBS = 2
WAYS = {  # nothing of it may change a result: (worker processes, tasks until one is replaced, PYTHONHASHSEED)
    "1 worker": (1, 200, "1"),
    "2 workers, a fresh process for each task": (2, 1, "20240607"),
    "4 workers": (4, 200, "77"),
}


def table1(options: Options) -> list[Figure]:
    """Drive Table I in full simulation."""
    return _claims("table1", f"--trials={options.table_trials}")


def figure4(options: Options) -> list[Figure]:
    """Draw the paper's figure in abstract simulation, also with the authors' own gamma and the other presets."""
    trials = f"--trials={options.figure_trials}"
    presets = ("", "tmpud:gamma=2500", "paper", "released")
    return [figure for preset in presets for figure in _claims("figure4", trials, preset)]


def calibration(options: Options) -> list[Figure]:  # noqa: ARG001
    """Measure how well Safe foretells an unsafe merge, and what the learned worlds foretell."""
    folder = ROOT / "results" / "calibration"
    _run("calibration", folder)
    _keep_files(folder, "calibration")
    done = read_results(folder).records
    faults = sum(record.status != "DONE" for record in done)
    result = f"{faults} tool faults; see docs/results/calibration/report.md"
    what = "merges forced locally and in the town, all predictors on the same scenes (tasks)"
    return [Figure(what=what, n=len(done), result=result, target="0 tool faults", holds=not faults, seed=60_000)]


def same_results(options: Options) -> list[Figure]:
    """Drive the same trials with other numbers of workers, cold and recycled, under other hash seeds."""
    grid = Table1(trials=options.same_trials).grid()
    tasks = [cell.task for cell in cells(grid)]
    experiment = Experiment(name="table1", options=grid.to_json())
    hashes = {}
    with tempfile.TemporaryDirectory() as name:
        for way, (jobs, recycle_after, hash_seed) in WAYS.items():
            os.environ["PYTHONHASHSEED"] = hash_seed  # of the workers
            folder, limits = Path(name) / str(jobs), Limits(jobs=jobs, recycle_after=recycle_after)
            progress = Progress(f"same results, {jobs}", len(tasks))
            hashes[way] = results_hash(run_campaign(folder, experiment, tasks, limits=limits, progress=progress))
    equal = len(set(hashes.values())) == 1
    return [
        Figure(
            what="one hash over the results of full trials, " + "; ".join(WAYS),
            n=len(tasks),
            result="equal" if equal else "different",
            target="equal",
            holds=equal,
            seed=FIRST_SEED,
            details={"hashes": hashes},
        )
    ]


def keep(found: Findings, name: str) -> list[Figure]:
    """Keep an experiment's report in the documentation and return a figure for each part of the paper's claim."""
    write_report(KEPT / name, found.report())
    (KEPT / name / "report.html").unlink()  # the Markdown and the picture are what a repository shows
    rows = found.analysis.findings
    conditions = list(dict.fromkeys(row.condition for row in rows))
    figures = []
    for part, text in PARTS.items():
        for condition in conditions:
            those = [row for row in rows if (row.claim.part, row.condition) == (part, condition)]
            verdict = worst(those)
            figures.append(
                Figure(
                    what=f"{name}, claim ({part}) {text}: {condition}",
                    n=min(row.difference.n for row in those),
                    result=f"{verdict}; docs/results/{name}/report.md",
                    target="holds, or consistent with it",
                    holds=verdict in (Verdict.HOLDS, Verdict.CONSISTENT),
                    seed=FIRST_SEED,
                    details={"results_hash": found.hash},
                )
            )
    return figures


def _claims(experiment: str, trials: str, preset: str = "") -> list[Figure]:
    name = experiment + "".join(f"-{word}" for word in preset.replace("=", ":").split(":") if word)
    folder = ROOT / "results" / f"{name}-{trials.partition('=')[2]}"
    _run(experiment, folder, trials, *(["--preset", preset] if preset else []))
    return keep(findings(read_results(folder)), name)


def _run(experiment: str, folder: Path, *options: str) -> None:
    """Run an experiment, or what is left of it, by the command line."""
    command = [str(Path(sys.executable).parent / "tmpud"), "paper", experiment, *options]
    subprocess.run([*command, f"--jobs={JOBS}", "--out", str(folder)], check=True, stdout=subprocess.DEVNULL)


def _keep_files(folder: Path, name: str) -> None:
    (KEPT / name).mkdir(parents=True, exist_ok=True)
    for file in (*folder.glob("*.svg"), *folder.glob("*.png"), folder / "report.md"):
        shutil.copy(file, KEPT / name / file.name)
