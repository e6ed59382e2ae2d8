"""How every experiment's tasks are run from the command line."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

if TYPE_CHECKING:
    from tmpud.experiments.running.store import Results
    from tmpud.experiments.running.tasks import Task
    from tmpud.experiments.running.workers import Limits


def run_tasks(
    name: str, options: Mapping[str, Any], tasks: Sequence[Task], out: Path | None, limits: Limits
) -> tuple[Path, Results]:
    """Run what is left of an experiment; return its folder and all that the folder holds then."""
    from tmpud.experiments.running.campaign import run_campaign
    from tmpud.experiments.running.manifest import Experiment
    from tmpud.experiments.running.progress import Progress
    from tmpud.experiments.running.store import read_results
    from tmpud.experiments.running.tasks import digest

    folder = out or Path("results") / f"{name}-{digest(options)[:8]}"
    typer.echo(f"{name}: {len(tasks)} tasks, {limits.jobs} at a time, into {folder}", err=True)
    experiment = Experiment(name=name, options=options, command=_command())
    for _ in run_campaign(folder, experiment, tasks, limits=limits, progress=Progress(name, len(tasks))):
        pass
    return folder, read_results(folder)


def _command() -> str:
    """Return the command that repeats this one, wherever its results go and however many work on it."""
    words = iter(["tmpud", *sys.argv[1:]])
    kept: list[str] = []
    for word in words:
        if word in ("--out", "--jobs"):
            next(words, None)
        elif word != "--json" and not word.startswith(("--out=", "--jobs=")):
            kept.append(word)
    return shlex.join(kept)
