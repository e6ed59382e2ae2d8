"""Plan without driving, and look at maps and programs: ``plan``, ``map`` and ``asp``."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Annotated, Any

import typer

from tmpud.cli.options import TOWN, From, Json, Map, PresetName, Seed, To, Via

app = typer.Typer()
map_app = typer.Typer(help="Look at maps.", no_args_is_help=True)
asp_app = typer.Typer(help="Look at the task planner's program.", no_args_is_help=True)
app.add_typer(map_app, name="map")
app.add_typer(asp_app, name="asp")


@app.command()
def plan(
    start: From,
    goal: To,
    map_: Map = TOWN,
    via: Via = None,
    seed: Seed = 7,
    preset: PresetName = "tmpud",
    as_json: Json = False,
) -> None:
    """Print the optimal task plan, proved by the solver; no simulator runs."""
    from tmpud.planning import Problem

    report = Problem.of(map_, start, goal, tuple(via or ()), seed=seed, preset=preset).solve()
    result = {
        "actions": [step.action.value for step in report.plan],
        "lanes": [step.state.segment.rpartition("/")[0] for step in report.plan]
        + [step.next_state.segment.rpartition("/")[0] for step in report.plan[-1:]],
        "cost_m": round(report.cost_m, 2),
        "penalty_m": round(report.penalty_m, 2),
        "optimal": report.optimal,
    }
    if as_json:
        typer.echo(json.dumps(result))
        return
    for step in report.plan:
        typer.echo(f"{step.action.value:<10}  {step.state.segment} -> {step.next_state.segment}")
    proof = "optimal, proved by clingo" if report.optimal else "not proved optimal"
    typer.echo(f"{report.cost_m:.2f} m + {report.penalty_m:.2f} m safety penalty, {len(report.plan)} actions; {proof}")


@map_app.command("info")
def map_info(map_: Annotated[str, typer.Argument(metavar="MAP")] = TOWN, as_json: Json = False) -> None:
    """Print what a map offers: segments, lanes, junctions, signals, transitions by action, warnings."""
    from dataclasses import asdict

    from tmpud.roads.loading import load_map
    from tmpud.roads.survey import survey

    facts: dict[str, Any] = asdict(survey(load_map(map_)))
    if as_json:
        typer.echo(json.dumps(facts))
        return
    for name, value in facts.items():
        shown = ", ".join(f"{key} {count}" for key, count in value.items()) if isinstance(value, dict) else value
        if isinstance(value, tuple | list):
            shown = "; ".join(map(str, value)) or "none"
        if isinstance(value, float):
            shown = f"{value:.3g}"
        typer.echo(f"{name.replace('_', ' '):<20}{shown}")


@asp_app.command("dump")
def asp_dump(
    start: From,
    goal: To,
    map_: Map = TOWN,
    via: Via = None,
    seed: Seed = 7,
    preset: PresetName = "tmpud",
    out: Annotated[Path, typer.Option(help="The folder to write the encodings and facts.lp into.")] = Path("asp"),
) -> None:
    """Write the facts of a mission beside the encodings, so that plain clingo finds the same optimum."""
    from tmpud.planning import Problem

    files = Problem.of(map_, start, goal, tuple(via or ()), seed=seed, preset=preset).dump(out)
    typer.echo(f"wrote {', '.join(file.name for file in files)} to {out}")
    typer.echo(f"try: {shlex.join(['python', '-m', 'clingo', *map(str, files)])}")
