"""See whether all is there: ``doctor``."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer

from tmpud.cli.options import Host, Json, Port, Sim

app = typer.Typer()


@app.command()
def doctor(
    sim: Annotated[Sim, typer.Option(help="Look for what this simulator needs, too.")] = Sim.SUMO,
    host: Host = "127.0.0.1",
    port: Port = 2000,
    as_json: Json = False,
) -> None:
    """Look whether all that a drive needs is there, and say what to do where it is not. Exit code 3 where not."""
    from tmpud.doctor import State, examine

    findings = []
    for finding in examine(sim, host, port):
        findings.append(finding)
        if not as_json:
            typer.echo(f"{finding.state:<5} {finding.what:<15} {finding.found}")
            if finding.remedy:
                typer.echo(f"{'':<21} -> {finding.remedy}")
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    if any(finding.state is State.BAD for finding in findings):
        raise typer.Exit(3)
