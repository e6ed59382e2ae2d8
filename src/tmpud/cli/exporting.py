"""Give a run to other programs: ``export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command()
def export(
    run: Annotated[Path, typer.Argument(help="A run folder, such as runs/demo.")],
    mcap: Annotated[
        Path, typer.Option(metavar="FILE", help="The MCAP file to write, for Foxglove and others; needs tmpud[mcap].")
    ],
) -> None:
    """Write a run for other viewers. Traffic, plans, Safe over time and what happened, as MCAP."""
    from tmpud.viewer.intact import read_intact
    from tmpud.viewer.mcap import write_mcap

    intact = read_intact(run)
    write_mcap(intact, mcap)
    for line in intact.missing:
        typer.echo(f"missing: {line}", err=True)
    typer.echo(f"wrote {mcap} ({mcap.stat().st_size / 1e3:,.0f} kB)")
