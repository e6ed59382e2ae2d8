"""Plan without driving, and look at maps and programs: ``plan``, ``map`` and ``asp``."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tmpud.cli.options import TOWN, Journey, Json, grouped

if TYPE_CHECKING:
    from tmpud.planning import Problem
    from tmpud.roads.network import RoadNetwork
    from tmpud.task.asp_planner import PlanReport

app = typer.Typer()
map_app = typer.Typer(help="Look at maps.", no_args_is_help=True)
asp_app = typer.Typer(help="Look at the task planner's program.", no_args_is_help=True)
app.add_typer(map_app, name="map")
app.add_typer(asp_app, name="asp")


@app.command()
@grouped
def plan(
    journey: Journey,
    rules: Annotated[
        Path | None, typer.Option(help="A .lp file of rules that every plan keeps; see docs/rules.md.")
    ] = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", help="Add what the proof took, wall-clock times among it.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Print the optimal task plan. The solver proves it; no simulator runs."""
    problem = _problem(journey)
    report = (problem.with_rules(rules) if rules else problem).solve()
    effort = _effort(report) if verbose else {}
    if as_json:
        typer.echo(json.dumps(_terms(report, with_rules=rules is not None) | effort))
        return
    for step in report.plan:
        typer.echo(f"{step.action.value:<10}  {step.state.segment} -> {step.next_state.segment}")
    added = f" + {report.rules_m:.2f} m by the rules" if rules else ""
    proof = "optimal, proved by clingo" if report.optimal else "not proved optimal"
    length = f"{report.cost_m:.2f} m + {report.penalty_m:.2f} m safety penalty{added}"
    typer.echo(f"{length}, {len(report.plan)} actions; {proof}")
    for name, value in effort.items():
        typer.echo(f"{name:<12}{value}")


def _terms(report: PlanReport, *, with_rules: bool) -> dict[str, Any]:
    """Return the plan and what it costs: the same for the same question, whatever the machine."""
    return {
        "actions": [step.action.value for step in report.plan],
        "lanes": [step.state.segment.rpartition("/")[0] for step in report.plan]
        + [step.next_state.segment.rpartition("/")[0] for step in report.plan[-1:]],
        "cost_m": round(report.cost_m, 2),
        "penalty_m": round(report.penalty_m, 2),
        **({"rules_m": round(report.rules_m, 2)} if with_rules else {}),
        "optimal": report.optimal,
    }


def _effort(report: PlanReport) -> dict[str, Any]:
    """Return what the proof took: the corridor's size, how many were tried, wall-clock times [ms]."""
    return {
        "transitions": report.transitions,
        "rounds": report.rounds,
        "ground_ms": round(report.ground_s * 1e3, 3),
        "solve_ms": round(report.solve_s * 1e3, 3),
    }


@map_app.command("info")
def map_info(
    map_: Annotated[
        str, typer.Argument(metavar="MAP", help="A shipped town's name or a .net.xml(.gz) or .xodr file.")
    ] = TOWN,
    *,
    edges: Annotated[
        bool, typer.Option("--edges", help="List the edges and their lanes, which --from and --to take.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Print what a map has. Counts segments, lanes, junctions, signals, transitions by action; lists warnings."""
    from dataclasses import asdict

    from tmpud.roads.loading import load_map
    from tmpud.roads.survey import survey

    network = load_map(map_)
    if edges:
        _list_edges(network, as_json=as_json)
        return
    facts: dict[str, Any] = asdict(survey(network))
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


@map_app.command("import")
def map_import(
    file: Annotated[Path, typer.Argument(metavar="FILE.xodr", help="A map in OpenDRIVE.")],
    *,
    out: Annotated[
        Path | None, typer.Option(help="The .net.xml(.gz) to write. Default: beside FILE, named like it.")
    ] = None,
) -> None:
    """Write an OpenDRIVE map as a SUMO net, by netconvert. Every command then takes the net as --map.

    plan and map info also take FILE.xodr itself, where CARLA's client is installed; docs/maps.md says what each keeps.
    """
    from tmpud.roads.loading import NETS
    from tmpud.roads.netconvert import import_net

    net = out or file.with_suffix(".net.xml.gz")
    if not net.name.endswith(NETS):
        raise typer.BadParameter(f"{net} is not named like a net: {' or '.join(NETS)}.", param_hint="--out")
    network = import_net(file, net)
    typer.echo(f"wrote {net}: {len(network.lanes)} lanes, {len(network.connections)} connections")


def _list_edges(network: RoadNetwork, *, as_json: bool) -> None:
    named = dict(sorted(network.edges.items()))
    if as_json:
        typer.echo(json.dumps(named))
        return
    for name, lanes in named.items():
        typer.echo(f"{name:<20}{', '.join(lanes)}")


@asp_app.command("dump")
@grouped
def asp_dump(
    journey: Journey,
    out: Annotated[Path, typer.Option(help="The folder to write the encodings and facts.lp into.")] = Path("asp"),
) -> None:
    """Write a mission's facts and the encodings. Plain clingo then finds the same optimum."""
    files = _problem(journey).dump(out)
    typer.echo(f"wrote {', '.join(file.name for file in files)} to {out}")
    typer.echo(f"try: {shlex.join(['python', '-m', 'clingo', *map(str, files)])}")


def _problem(journey: Journey) -> Problem:
    from tmpud.planning import Problem

    via = tuple(journey.via or ())
    return Problem.of(journey.map, journey.start, journey.goal, via, seed=journey.seed, preset=journey.preset)
