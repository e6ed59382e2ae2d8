"""Drive one mission: ``demo`` and ``drive``."""

from __future__ import annotations

import gc
import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tmpud.cli.filming import Cutting, Films, write_films
from tmpud.cli.options import TOWN, Algorithm, Beta, Journey, Json, Out, Seed, Simulated, Traffic, grouped

if TYPE_CHECKING:
    from tmpud.runner import Mission, SimulatorFactory

app = typer.Typer()

DEMO_SEED, DEMO_TRAFFIC = 16, 200


@app.command()
def demo(seed: Seed = DEMO_SEED, out: Out = None) -> None:
    """Drive the paper's mission in dense traffic. Tells the story as it goes and writes a run folder."""
    from tmpud.roads.towns import PAPER_MISSIONS
    from tmpud.runner import Mission, sumo

    paper = PAPER_MISSIONS[TOWN]
    mission = Mission(map=TOWN, start=paper.start, goal=paper.goal, seed=seed, traffic=DEMO_TRAFFIC)
    _drive(mission, out or Path("runs/demo"), sumo, as_json=False)


@app.command()
@grouped
def drive(
    journey: Journey,
    where: Simulated,
    algorithm: Algorithm = "tmpud",
    beta: Beta = None,
    traffic: Traffic = 120,
    out: Out = None,
    frames: Annotated[bool, typer.Option(help="Record all traffic ten times a second, for the replay.")] = True,
    *,
    films: Films,
    as_json: Json = False,
) -> None:
    """Drive one mission in a simulator's traffic. The run is judged and written into a folder."""
    from tmpud.cli.simulating import map_of, simulator
    from tmpud.runner import Mission

    if films and not frames:
        raise typer.BadParameter("an animation needs what --no-frames leaves out.", param_hint="'--no-frames'")
    if beta is not None and algorithm != "threshold":
        raise typer.BadParameter(f"only --algorithm threshold accepts by it, not {algorithm}.", param_hint="'--beta'")
    films.check()

    mission = Mission(
        map=map_of(where, journey.map),
        start=journey.start,
        goal=journey.goal,
        via=tuple(journey.via or ()),
        algorithm=algorithm,
        **({} if beta is None else {"beta": beta}),
        traffic=traffic,
        seed=journey.seed,
        preset=journey.preset,
    )
    folder = out or Path("runs") / _name(mission)
    _drive(mission, folder, simulator(where), as_json=as_json, frames=frames, films=films)


def _name(mission: Mission) -> str:
    """Return what a mission's run folder is called where its user does not say."""
    from tmpud.recording import run_name

    town = Path(mission.map).name.split(".")[0]
    return run_name(f"{town}-{mission.preset}-{mission.algorithm}-{mission.seed}")


def _drive(
    mission: Mission,
    folder: Path,
    simulator: SimulatorFactory,
    *,
    as_json: bool,
    frames: bool = True,
    films: Films | None = None,
) -> None:
    from tmpud.events import Event
    from tmpud.execution.timing import Stopwatch
    from tmpud.presets import preset_named
    from tmpud.recording import PICTURE, record, record_timing
    from tmpud.roads.loading import load_map
    from tmpud.runner import drive as run
    from tmpud.story import Story, summarise
    from tmpud.viewer.intact import read_intact
    from tmpud.viewer.picture import draw_run

    watch, story = Stopwatch(), Story()
    events: list[Event] = []
    for event in record(run(mission, simulator=simulator, stopwatch=watch, frames=frames), folder):
        if not events:  # all is loaded
            gc.freeze()  # else looking through it for garbage holds up one estimate or step for 60 ms
        events.append(event)
        if not as_json:
            for line in story.tell(event):
                typer.echo(line)
    record_timing(watch, folder)
    draw_run(load_map(mission.map, preset_named(mission.preset).segment_length), events, folder / PICTURE)
    summary = summarise(events) | {"latency_ms": watch.summary()}
    _report(summary, folder, as_json=as_json)
    if films:
        write_films(read_intact(folder), films, Cutting())
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
