"""Experiments: ``paper``, ``sweep`` and ``results``."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from textwrap import indent
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tmpud.cli.options import TOWN, Jobs, Json, Map, Running, Setting, Sim, Simulated, grouped
from tmpud.cli.running import run_tasks

if TYPE_CHECKING:
    from tmpud.experiments.kinds import Findings
    from tmpud.experiments.running.tasks import Task
    from tmpud.experiments.running.workers import Limits
    from tmpud.experiments.trials.grid import Grid

app = typer.Typer()
paper_app = typer.Typer(help="Repeat the paper's experiments.", no_args_is_help=True)
app.add_typer(paper_app, name="paper")

ON_A_SERVER = 4 * 3600.0  # [s] for a trial: 1,800 simulated seconds at 5 steps a second take two hours

SWEEP = """\
maps: [millbrook]
missions: [paper, "random:5", {from: park1e_0, to: high4n}]
traffic: {normal: 120, heavy: 200}
algorithms: [tmpud, threshold(0.3), no-com]
presets: [tmpud, "tmpud:gamma=1500"]
seeds: 0..19
"""


@paper_app.command()
@grouped
def table1(
    *,
    trials: Annotated[int, typer.Option(min=1, max=100_000, help="Trials per algorithm and density.")] = 200,
    setting: Setting,
    first_seed: Annotated[int, typer.Option(min=0, help="Seed of the first trial.")] = 1000,
    where: Simulated,
    running: Running,
) -> None:
    """Repeat Table I in full simulation. Five algorithms, normal and heavy traffic, paired seeds."""
    from tmpud.cli.simulating import map_of, server_of
    from tmpud.experiments.trials.table1 import Table1

    drawn = replace(setting, map=map_of(where, setting.map))
    asked = Table1(**asdict(drawn), trials=trials, first_seed=first_seed, server=server_of(where))
    _of_grid("table1", asked.grid(), where, running)


@paper_app.command()
@grouped
def figure4(
    *,
    trials: Annotated[int, typer.Option(min=1, max=1_000_000, help="Trials per algorithm and road condition.")] = 4000,
    batches: Annotated[int, typer.Option(min=1, max=1000, help="How many shares the trials are split into.")] = 4,
    setting: Setting,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the draws.")] = 1000,
    world: Annotated[Path | None, typer.Option(help="What learn-world wrote; default: the shipped models.")] = None,
    running: Running,
) -> None:
    """Repeat the paper's figure in abstract simulation. Five algorithms under four road conditions."""
    from tmpud.experiments.running.workers import Limits
    from tmpud.experiments.trials.figure4 import Figure4
    from tmpud.experiments.worlds.models import SHIPPED

    models = str(world) if world else SHIPPED
    asked = Figure4(**asdict(setting), trials=trials, batches=batches, seed=seed, world=models)
    _experiment("figure4", asked.to_json(), asked.tasks(), running, Limits(jobs=running.jobs, together=False))


@paper_app.command()
@grouped
def calibration(
    *,
    merges: Annotated[
        int, typer.Option(min=0, max=100_000, help="Merges in a small area, for each road condition.")
    ] = 400,
    drives: Annotated[int, typer.Option(min=0, max=100_000, help="Drives through the town, for each density.")] = 60,
    first_seed: Annotated[int, typer.Option(min=0, help="Seed of the first drive.")] = 60_000,
    map_: Map = TOWN,
    running: Running,
) -> None:
    """Measure how well Safe foretells an unsafe merge. Beside it: gap, time to collision and RSS distance."""
    from tmpud.experiments.calibration.foresight import check_table, checks
    from tmpud.experiments.calibration.predictions import measured, quality_table, to_json
    from tmpud.experiments.calibration.report import calibration_report, calibration_tasks
    from tmpud.experiments.reports.document import write_report
    from tmpud.experiments.reports.table import as_text
    from tmpud.experiments.running.store import provenance
    from tmpud.experiments.running.workers import Limits
    from tmpud.experiments.worlds.models import read_world

    options = {"merges": merges, "drives": drives, "first_seed": first_seed, "map": map_}
    tasks = calibration_tasks(merges, drives, first_seed, map_)
    limits = Limits(jobs=running.jobs, together=False)
    folder, results = run_tasks("calibration", options, tasks, running.out, limits)
    found, worlds = measured(results.records), checks(results.records, read_world())
    files = write_report(folder, calibration_report(found, worlds, results.manifest["command"], provenance(results)))
    if running.as_json:
        typer.echo(json.dumps({"sources": to_json(found), "worlds": [check.to_json() for check in worlds]}))
    else:
        tables = [*(quality_table(*pair) for pair in found), check_table(worlds)]
        typer.echo("\n\n".join(map(as_text, tables)))
    typer.echo(f"wrote {', '.join(file.name for file in files)} to {folder}", err=True)


@app.command()
def learn_world(
    merges: Annotated[int, typer.Option(min=1, max=1_000_000, help="Forced merges for each road condition.")] = 2000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of places, speeds and accelerations.")] = 2024,
    jobs: Jobs = 2,
    out: Annotated[Path, typer.Option(help="The file to write; FILE.runs keeps what was run.")] = Path("world.json"),
) -> None:
    """Learn the abstract simulation's models. Forces merges in a small area of the full simulator."""
    from datetime import UTC, datetime

    from tmpud.experiments.running.workers import Limits
    from tmpud.experiments.worlds.learning import tasks, to_json, world

    options, runs = {"merges": merges, "seed": seed}, out.with_name(out.name + ".runs")
    _, results = run_tasks("learn-world", options, tasks(merges, seed), runs, Limits(jobs=jobs, together=False))
    command, time = results.manifest["command"], datetime.now(UTC).isoformat(timespec="seconds")
    learned = world(results.records, merges=merges, seed=seed, command=command, time=time)
    out.write_text(to_json(learned), encoding="utf-8")
    for condition, row in learned["conditions"].items():
        shares = ", ".join(f"{name} {share['value']:.3f}" for name, share in row["outcomes"].items())
        typer.echo(f"{condition}: {shares}")
    typer.echo(f"wrote {out}", err=True)


@app.command(epilog="\b\nA file, of which every key may be left out:\n" + indent(SWEEP, "  "))
@grouped
def sweep(
    file: Annotated[Path, typer.Argument(metavar="FILE.yaml", help="What is driven, as below.")],
    where: Simulated,
    running: Running,
) -> None:
    """Drive any grid of missions and settings. A file says which; its trials are driven, counted and compared."""
    from tmpud.cli.simulating import map_of, server_of
    from tmpud.experiments.trials.sweep import read_sweep

    _of_grid("sweep", read_sweep(file, server_of(where), partial(map_of, where)), where, running)


@app.command()
def results(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that an experiment wrote.")],
    compare: Annotated[Path | None, typer.Option(metavar="DIR", help="Another run to compare it with.")] = None,
    export: Annotated[Path | None, typer.Option(metavar="FILE", help="A .csv, .json or .parquet to write.")] = None,
    as_json: Json = False,
) -> None:
    """Print, export or compare an experiment's results. Comparison goes trial by trial."""
    from tmpud.experiments.kinds import findings
    from tmpud.experiments.reports.export import write_rows
    from tmpud.experiments.running.store import read_results

    found = findings(read_results(folder))
    for damage in found.results.damages:
        typer.echo(f"tmpud: {damage}", err=True)
    if export:
        write_rows(found.rows, export)
        typer.echo(f"wrote {len(found.rows)} trials to {export}", err=True)
    if compare:
        _compare(found, findings(read_results(compare)), as_json=as_json)
    else:
        _tell(found, as_json=as_json)


def _of_grid(name: str, grid: Grid, where: Simulated, running: Running) -> None:
    """Run a grid of trials. A CARLA server drives one at a time, as slowly as it may: each of its steps is watched."""
    from tmpud.experiments.running.workers import Limits
    from tmpud.experiments.trials.grid import cells

    tasks = [cell.task for cell in cells(grid)]
    if where.sim is Sim.SUMO:
        _experiment(name, grid.to_json(), tasks, running)
    else:
        _experiment(f"{name}-carla", grid.to_json(), tasks, running, Limits(jobs=1, task=ON_A_SERVER))


def _experiment(
    name: str, options: Mapping[str, Any], tasks: Sequence[Task], running: Running, limits: Limits | None = None
) -> None:
    """Run what is left of an experiment of trials, write its report, and say what came out."""
    from tmpud.experiments.kinds import findings
    from tmpud.experiments.reports.document import write_report
    from tmpud.experiments.reports.export import write_rows
    from tmpud.experiments.running.workers import Limits

    folder, results = run_tasks(name, options, tasks, running.out, limits or Limits(jobs=running.jobs))
    found = findings(results)
    write_rows(found.rows, folder / "trials.csv")
    files = write_report(folder, found.report())
    _tell(found, as_json=running.as_json)
    typer.echo(f"wrote {', '.join(file.name for file in files)}, trials.csv to {folder}", err=True)


def _tell(found: Findings, *, as_json: bool) -> None:
    from tmpud.experiments.reports.table import as_text, findings_table, verdicts

    if as_json:
        typer.echo(json.dumps(found.to_json()))
        return
    analysis = found.analysis
    typer.echo(as_text(analysis.table(found.kind.title)))
    if analysis.findings:
        typer.echo("\n" + as_text(findings_table(analysis.findings)))
    done = f"results {found.hash}, {len(found.results.records)} tasks done"
    for line in ("", *verdicts(analysis.findings), "", done):
        typer.echo(line)


def _compare(first: Findings, second: Findings, *, as_json: bool) -> None:
    from tmpud.experiments.reports.comparison import compare_runs
    from tmpud.experiments.reports.table import as_text

    table = compare_runs(first.rows, second.rows)
    if as_json:
        typer.echo(json.dumps([dict(zip(table.columns, row, strict=True)) for row in table.rows]))
    else:
        typer.echo(as_text(table))
