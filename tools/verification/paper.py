"""Sections about the paper's experiments: run in full by the command line, their reports kept in ``docs/results``."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tmpud.experiments.calibration.foresight import Check, checks
from tmpud.experiments.calibration.predictions import measured
from tmpud.experiments.kinds import Findings, findings
from tmpud.experiments.reports.document import write_report
from tmpud.experiments.reports.table import interval
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.progress import Progress
from tmpud.experiments.running.store import read_results
from tmpud.experiments.running.tasks import DONE, results_hash
from tmpud.experiments.running.workers import Limits
from tmpud.experiments.statistics.claims import PARTS, Finding, Verdict, worst
from tmpud.experiments.trials.grid import cells
from tmpud.experiments.trials.table1 import FIRST_SEED, Table1
from tmpud.experiments.worlds.models import read_world
from tools.verification.figures import ROOT, Figure
from tools.verification.options import Options

KEPT = ROOT / "docs" / "results"
JOBS = 2
PRESETS = ("paper", "released")  # beside the default
OTHERS = ("tmpud:gamma=2500", *PRESETS)  # 2500 m is the authors' own gamma
WAYS = {  # nothing of it may change a result: (worker processes, tasks until one is replaced, PYTHONHASHSEED)
    "1 worker": (1, 200, "1"),
    "2 workers, a fresh process for each task": (2, 1, "20240607"),
    "4 workers": (4, 200, "77"),
}


def table1(options: Options) -> list[Figure]:
    """Drive Table I in full simulation."""
    return _claims("table1", f"--trials={options.table_trials}")


def table1_presets(options: Options) -> list[Figure]:
    """Drive Table I with the other presets, too."""
    trials = f"--trials={options.table_trials}"
    return [figure for preset in PRESETS for figure in _claims("table1", trials, preset)]


def figure4(options: Options) -> list[Figure]:
    """Draw the paper's figure in abstract simulation, also with the authors' own gamma and the other presets."""
    trials = f"--trials={options.figure_trials}"
    return [figure for preset in ("", *OTHERS) for figure in _claims("figure4", trials, preset)]


def calibration(options: Options) -> list[Figure]:  # noqa: ARG001
    """Measure how well Safe foretells an unsafe merge, and what the learned worlds foretell."""
    folder = ROOT / "results" / "calibration"
    _run("calibration", folder)
    return keep_calibration(folder)


def keep_calibration(folder: Path) -> list[Figure]:
    """Keep the report of a calibration that was run, and return its figures."""
    _keep_files(folder, "calibration")
    results = read_results(folder)
    done, seed = results.records, results.manifest["options"]["first_seed"]
    faults = sum(record.status != DONE for record in done)
    foretold = [check for check in checks(done, read_world()) if check.foretold is not None]
    areas = [
        f"{merges.source} {interval(quality.area, 3)}"
        for merges, qualities in measured(done)
        for quality in qualities
        if quality.score == "tmpud"
    ]
    return [
        Figure(
            what="merges forced locally and in the town, all predictors asked about the same scenes (tasks)",
            n=len(done),
            result=f"{faults} tool faults; area under tmpud's ROC curve: {', '.join(areas)}; "
            "docs/results/calibration/report.md",
            target="0 tool faults",
            holds=not faults,
            seed=seed,
        ),
        Figure(
            what="unsafe share of merges that the learned worlds foretell, against the town's (merges)",
            n=sum(check.seen.n for check in foretold),
            result="; ".join(map(_off, foretold)),
            target="within the town's 95 % interval; if not, by how much it is off",
            holds=all(check.holds for check in foretold),
            seed=seed,
        ),
    ]


def _off(check: Check) -> str:
    off = "" if check.holds else f", off by {check.off:+.3f}"
    at_gaps = f" ({check.at_gaps:.3f} at the town's gaps)" if check.at_gaps is not None else ""
    return f"with {check.neighbours} around: {check.foretold:.3f}{at_gaps} against {interval(check.seen, 3)}{off}"


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
    return [
        Figure(
            what=f"{name}, claim ({part}) {text}",
            n=min(row.difference.n for row in rows),
            result=f"{_by_verdict(rows)}; docs/results/{name}/report.md",
            target="holds, or consistent with it",
            holds=worst(rows) in (Verdict.HOLDS, Verdict.CONSISTENT),
            seed=FIRST_SEED,
            details={"results_hash": found.hash},
        )
        for part, text in PARTS.items()
        for rows in [[row for row in found.analysis.findings if row.claim.part == part]]
    ]


def _by_verdict(rows: Sequence[Finding]) -> str:
    """Return each verdict with the conditions under which it was found, or alone where it was found under all."""
    conditions: dict[Verdict, list[str]] = {}
    for condition in dict.fromkeys(row.condition for row in rows):
        verdict = worst([row for row in rows if row.condition == condition])
        conditions.setdefault(verdict, []).append(condition)
    if len(conditions) == 1:
        return str(*conditions)
    return "; ".join(f"{verdict}: {' / '.join(names)}" for verdict, names in conditions.items())


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
