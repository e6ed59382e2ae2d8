"""The options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

TOWN = "millbrook"

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
