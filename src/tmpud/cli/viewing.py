"""Look at runs: ``replay``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def replay(
    run: Annotated[Path, typer.Argument(help="A run folder, such as runs/demo.")],
    html: Annotated[Path | None, typer.Option(help="The page to write; default: replay.html in the folder.")] = None,
) -> None:
    """Write one HTML page that plays a run. Open it in a browser, send it to somebody."""
    from tmpud.recording import REPLAY
    from tmpud.viewer.replay import write_replay

    file = html or run / REPLAY
    for line in write_replay(run, file):
        typer.echo(f"missing: {line}", err=True)
    typer.echo(f"wrote {file} ({file.stat().st_size / 1e3:,.0f} kB)")
