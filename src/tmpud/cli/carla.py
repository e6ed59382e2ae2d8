"""For whoever has a CARLA server: ``carla verify``."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Annotated

import typer

from tmpud.cli.options import Host, Json, Port, Seed, Traffic

app = typer.Typer()
carla_app = typer.Typer(help="Work with a CARLA server.", no_args_is_help=True)
app.add_typer(carla_app, name="carla")


@carla_app.callback()
def carla() -> None:
    pass


@carla_app.command()
def verify(
    map_: Annotated[str, typer.Option("--map", "-m", help="One of the server's maps.")] = "Town05",
    host: Host = "127.0.0.1",
    port: Port = 2000,
    traffic: Traffic = 20,
    seed: Seed = 1,
    as_json: Json = False,
) -> None:
    """Try a CARLA server thing by thing. Loads the map several times; exit code 1 where something fails."""
    from tmpud.simulators.carla import verify as verifying
    from tmpud.simulators.carla.session import Address

    checks = []
    for check in verifying.verify(Address(host=host, port=port), map_, traffic, seed):
        checks.append(check)
        if not as_json:
            typer.echo(f"{'pass' if check.passed else 'FAIL':<5} {check.what:<14} {check.found}")
    if as_json:
        typer.echo(json.dumps([asdict(check) for check in checks], indent=2))
    if not all(check.passed for check in checks):
        raise typer.Exit(1)
