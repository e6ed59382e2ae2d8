"""The options that several commands share, and how a command takes a group of them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import MISSING, dataclass, fields, is_dataclass
from enum import StrEnum
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

TOWN = "millbrook"


def number(value: float | None) -> float | None:
    """Refuse nan, which some versions of typer find in every range."""
    if value is not None and math.isnan(value):
        raise typer.BadParameter(f"{value} is not a number.")
    return value


Map = Annotated[
    str, typer.Option("--map", "-m", help="A shipped town's name (millbrook) or a .net.xml(.gz) or .xodr file.")
]
From = Annotated[str, typer.Option("--from", help="Start: a lane or edge id, x,y in map coordinates, or random.")]
To = Annotated[str, typer.Option("--to", help="Goal, like --from.")]
Via = Annotated[list[str] | None, typer.Option("--via", help="A place on the way; repeat for more, in their order.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of all that is random.")]
Preset = Annotated[
    str,
    typer.Option(
        help="How the method's open points are settled: tmpud, paper, released, or one changed: tmpud:gamma=1500."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Out = Annotated[
    Path | None, typer.Option(help="The run folder to write; a run already there is replaced. Default: runs/<name>.")
]
Traffic = Annotated[int, typer.Option(min=0, help="How many other vehicles circulate.")]
Algorithm = Annotated[
    str,
    typer.Option(
        help="tmpud weighs Safe against distance, threshold refuses actions below --beta, no-com ignores Safe."
    ),
]
Beta = Annotated[
    float | None,
    typer.Option(min=0.0, max=1.0, callback=number, help="The least Safe that threshold accepts.  [default: 0.3]"),
]
Missions = Annotated[str, typer.Option(help="paper, or random:N: N random missions over which the trials are spread.")]
Jobs = Annotated[int, typer.Option(min=1, max=256, help="Worker processes; they never change a result.")]
Folder = Annotated[
    Path | None,
    typer.Option("--out", help="The folder to write, or to go on in; default: results/<name>-<digest of the options>."),
]


class Sim(StrEnum):
    SUMO = "sumo"
    CARLA = "carla"


Host = Annotated[str, typer.Option(help="Where CARLA's server runs.")]
Port = Annotated[int, typer.Option(min=1, max=65535, help="Its port.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Simulated:
    """In which simulator to drive, and where that runs."""

    sim: Annotated[Sim, typer.Option(help="Drive in SUMO, or on a CARLA server; --map is then one of its maps.")] = (
        Sim.SUMO
    )
    host: Host = "127.0.0.1"
    port: Port = 2000


@dataclass(frozen=True, slots=True, kw_only=True)
class Journey:
    """Where to drive, and how plans are judged."""

    start: From
    goal: To
    map: Map = TOWN
    via: Via = None
    seed: Seed = 7
    preset: Preset = "tmpud"


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """What all trials of one of the paper's experiments have in common."""

    map: Map = TOWN
    missions: Missions = "paper"
    preset: Preset = "tmpud"


@dataclass(frozen=True, slots=True, kw_only=True)
class Running:
    """How an experiment is run and told; nothing of it changes a result."""

    jobs: Jobs = 2
    out: Folder = None
    as_json: Json = False


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command an option for each field of those of its parameters that are dataclasses."""
    hints = get_type_hints(command, include_extras=True)
    groups: dict[str, Any] = {name: kind for name, kind in hints.items() if is_dataclass(kind)}

    @wraps(command)
    def run(**given: Any) -> None:
        for name, kind in groups.items():
            given[name] = kind(**{field.name: given.pop(field.name) for field in fields(kind)})
        command(**given)

    options: list[Parameter] = []
    for name, parameter in signature(command).parameters.items():
        options += _options(groups[name]) if name in groups else [_option(name, hints[name], parameter.default)]
    run.__annotations__ = {option.name: option.annotation for option in options}
    run.__signature__ = Signature(options)  # type: ignore[attr-defined]
    return run


def _options(kind: Any) -> list[Parameter]:
    hints = get_type_hints(kind, include_extras=True)
    none = Parameter.empty
    return [
        _option(field.name, hints[field.name], none if field.default is MISSING else field.default)
        for field in fields(kind)
    ]


def _option(name: str, annotation: Any, default: Any) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, annotation=annotation, default=default)
