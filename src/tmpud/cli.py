"""The command line. Every command imports what it needs when it runs, so that ``--help`` is quick."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from tmpud.errors import TmpudError

if TYPE_CHECKING:
    from tmpud.runner import Mission

app = typer.Typer(
    help="Safe and efficient urban driving by task-motion planning (TMPUD).",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
map_app = typer.Typer(help="Look at maps.", no_args_is_help=True)
asp_app = typer.Typer(help="Look at the task planner's program.", no_args_is_help=True)
app.add_typer(map_app, name="map")
app.add_typer(asp_app, name="asp")

INTERRUPTED = 130  # exit code
TOWN = "millbrook"
DEMO_SEED, DEMO_TRAFFIC = 22, 200

Map = Annotated[str, typer.Option("--map", "-m", help="A shipped town's name or a .net.xml(.gz) file.")]
From = Annotated[str, typer.Option("--from", help="Start: a lane or edge id, x,y in map coordinates, or random.")]
To = Annotated[str, typer.Option("--to", help="Goal, like --from.")]
Via = Annotated[list[str] | None, typer.Option("--via", help="A place on the way; repeat for more, in their order.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of random places, traffic and sampling.")]
PresetName = Annotated[
    str, typer.Option("--preset", help="How the method's open points are settled: tmpud, paper or released.")
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Out = Annotated[Path | None, typer.Option(help="The run folder to write; default: runs/<name>.")]
Traffic = Annotated[int, typer.Option(min=0, help="How many other vehicles circulate.")]
Algorithm = Annotated[str, typer.Option(help="tmpud, no-com or threshold.")]
Beta = Annotated[float, typer.Option(min=0.0, max=1.0, help="The least Safe that threshold accepts.")]


@app.command()
def demo(seed: Seed = DEMO_SEED, out: Out = None) -> None:
    """Drive the shipped town's paper mission in traffic and tell the story."""
    from tmpud.roads.towns import PAPER_MISSIONS
    from tmpud.runner import Mission

    paper = PAPER_MISSIONS[TOWN]
    mission = Mission(map=TOWN, start=paper.start, goal=paper.goal, seed=seed, traffic=DEMO_TRAFFIC)
    _drive(mission, out or Path("runs/demo"), as_json=False)


@app.command()
def drive(
    start: From,
    goal: To,
    map_: Map = TOWN,
    via: Via = None,
    algorithm: Algorithm = "tmpud",
    beta: Beta = 0.3,
    traffic: Traffic = 120,
    seed: Seed = 7,
    preset: PresetName = "tmpud",
    out: Out = None,
    frames: Annotated[bool, typer.Option(help="Record what can be seen, ten times a second.")] = True,
    as_json: Json = False,
) -> None:
    """Drive a service request in SUMO's traffic, judge it, and write a run folder."""
    from tmpud.runner import Mission

    mission = Mission(
        map=map_,
        start=start,
        goal=goal,
        via=tuple(via or ()),
        algorithm=algorithm,
        beta=beta,
        traffic=traffic,
        seed=seed,
        preset=preset,
    )
    name = f"{Path(map_).name.split('.')[0]}-{preset}-{algorithm}-{seed}".lower()
    _drive(mission, out or Path("runs") / name, as_json=as_json, frames=frames)


def _drive(mission: Mission, folder: Path, *, as_json: bool, frames: bool = True) -> None:
    from tmpud.events import Event
    from tmpud.execution.timing import Stopwatch
    from tmpud.presets import preset_named
    from tmpud.recording import PICTURE, record, record_timing
    from tmpud.roads.loading import load_map
    from tmpud.runner import drive as run
    from tmpud.story import Story, summarise
    from tmpud.viewer.picture import draw_run

    watch, story = Stopwatch(), Story()
    events: list[Event] = []
    for event in record(run(mission, stopwatch=watch, frames=frames), folder):
        events.append(event)
        if not as_json:
            for line in story.tell(event):
                typer.echo(line)
    record_timing(watch, folder)
    draw_run(load_map(mission.map, preset_named(mission.preset).segment_length), events, folder / PICTURE)
    summary = summarise(events) | {"latency_ms": watch.summary()}
    _report(summary, folder, as_json=as_json)
    if summary["status"] != "SUCCESS":
        raise typer.Exit(1)


def _report(summary: dict[str, Any], folder: Path, *, as_json: bool) -> None:
    from tmpud.recording import LOG, PICTURE, TIMING
    from tmpud.story import closing

    if as_json:
        typer.echo(json.dumps(summary))
        return
    for line in (*closing(summary), "", f"wrote {PICTURE}, {LOG}, {TIMING} to {folder}"):
        typer.echo(line)


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


def main() -> None:
    """Run the command line; a user's error is one line on stderr."""
    debug = "--debug" in sys.argv
    if debug:
        sys.argv.remove("--debug")
    try:
        code = app(standalone_mode=False) or 0
        if code == INTERRUPTED:
            _fail("", INTERRUPTED)
        sys.exit(code)
    except KeyboardInterrupt:
        _fail("", INTERRUPTED)
    except Exception as error:
        if debug or not (code := _exit_code(error)):
            raise
        if type(error).__name__ == "NoArgsIsHelpError":
            error.show()  # type: ignore[attr-defined]
            sys.exit(code)
        _fail(error.format_message() if hasattr(error, "format_message") else str(error), code)


def _exit_code(error: Exception) -> int:
    """Return the exit code for an error of the user's, 0 for any other."""
    if isinstance(error, TmpudError):
        return error.exit_code
    if type(error).__name__ == "Abort":
        return INTERRUPTED
    return 2 if isinstance(error, OSError) or hasattr(error, "format_message") else 0


def _fail(message: str, code: int) -> NoReturn:
    typer.echo(f"tmpud: {message or 'interrupted; what was recorded is kept'}", err=True)
    sys.exit(code)


if __name__ == "__main__":
    main()
