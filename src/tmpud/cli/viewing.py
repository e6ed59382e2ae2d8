"""Look at runs: ``replay`` and ``view``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tmpud.cli.filming import Cutting, Films, write_films
from tmpud.cli.options import grouped

app = typer.Typer()


@app.command()
@grouped
def replay(
    run: Annotated[Path, typer.Argument(help="A run folder, such as runs/demo; with --trial, a results folder.")],
    other: Annotated[
        Path | None,
        typer.Option("--with", help="A second run on the same map, to be played beside the first, in step."),
    ] = None,
    html: Annotated[
        Path | None,
        typer.Option(help="The page to write; default: replay.html in the folder, compare.html for two runs."),
    ] = None,
    trial: Annotated[
        str | None,
        typer.Option(metavar="KEY", help="A trial to drive again, such as heavy/00017/tmpud, into a folder in runs."),
    ] = None,
    *,
    films: Films,
    cutting: Cutting,
) -> None:
    """Write one HTML page that plays a run, or compares two; open it in a browser, send it. Or write an animation."""
    films.check()
    if trial:
        run = _driven_again(run, trial)
    else:
        _refuse_experiment(run)
    if films:
        from tmpud.viewer.intact import read_intact

        write_films(read_intact(run), films, cutting)
    if html or other or not films:
        _write_page(run, other, html)


def _refuse_experiment(folder: Path) -> None:
    from tmpud.errors import RequestError
    from tmpud.experiments.running.store import RESULTS
    from tmpud.recording import LOG

    if (folder / RESULTS).is_file() and not (folder / LOG).exists():
        ways = f"tmpud view {folder} shows it, and --trial KEY replays one of its trials"
        raise RequestError(f"{folder} holds an experiment, not a run: {ways}")


def _write_page(run: Path, other: Path | None, html: Path | None) -> None:
    from tmpud.recording import COMPARISON, REPLAY
    from tmpud.viewer.replay import write_comparison, write_replay

    file = html or run / (COMPARISON if other else REPLAY)
    for line in write_comparison(run, other, file) if other else write_replay(run, file):
        typer.echo(f"missing: {line}", err=True)
    typer.echo(f"wrote {file} ({file.stat().st_size / 1e3:,.0f} kB)")


def _driven_again(results: Path, key: str) -> Path:
    """Drive a trial again; return its run folder."""
    from tmpud.events import Frame
    from tmpud.experiments.again import caveats, differences, drive_again, trial_of
    from tmpud.experiments.running.store import read_results
    from tmpud.recording import run_name

    found = read_results(results)
    trial = trial_of(found, key)
    folder = Path("runs") / run_name(f"{results.resolve().name}-{key}")
    log = [event for event in drive_again(trial, folder) if not isinstance(event, Frame)]
    if different := differences(trial, log):
        for line in [*different, *caveats(found)]:
            typer.echo(f"not the same as what was kept: {line}", err=True)
    else:
        typer.echo(f"drove {key} again into {folder}: all that was kept of it is the same")
    return folder


@app.command()
def view(
    where: Annotated[
        Path | None,
        typer.Argument(
            metavar="[RUN|DIR]",
            help="A run, or a folder in which to look for runs and experiments; default: runs and results, or here.",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65_535, help="The port to serve on; 0: any that is free.")] = 0,
) -> None:
    """Show runs and experiments in a browser, also while they are written. Ctrl-C ends it."""
    from tmpud.server.serving import listen, serve

    try:
        listener = listen(port)
    except OSError as error:
        raise typer.BadParameter(f"{port} cannot be had: {error.strerror}.", param_hint="'--port'") from error
    usual = [folder for folder in (Path("runs"), Path("results")) if folder.is_dir()]
    with listener:
        serve([where] if where else usual or [Path()], listener, typer.echo)
