"""A grid of trials as a user writes it down: a YAML file."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from tmpud.errors import RequestError, TmpudError
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS
from tmpud.experiments.trials.grid import Grid, Route, cells

_RANGE = re.compile(r"(\d{1,9})\.\.(\d{1,9})")
MOST_SEEDS = 100_000

Vehicles = Annotated[int, Field(ge=0, le=5000)]


def _list(value: Any) -> Any:
    """Let one value stand for a list of one."""
    return value if isinstance(value, list) else [value]


def _seeds(value: Any) -> Any:
    """Let "0..199" stand for the numbers from the first to the last."""
    if isinstance(value, str) and (found := _RANGE.fullmatch(value)):
        seeds = range(int(found[1]), int(found[2]) + 1)
        if len(seeds) > MOST_SEEDS:
            raise ValueError(f"{value} are {len(seeds):,} seeds; at most {MOST_SEEDS:,} can be swept")
        return list(seeds)
    return _list(value)


def _densities(value: Any) -> Any:
    """Let a list of vehicle counts name its conditions itself."""
    if isinstance(value, dict):
        return value
    return {f"{count} vehicles": count for count in _list(value)}


def _different(values: list[Any]) -> list[Any]:
    if twice := [value for value in values if values.count(value) > 1]:
        raise ValueError(f"{twice[0]} stands there twice")
    return values


class _Places(BaseModel):
    model_config = ConfigDict(extra="forbid")
    start: str = Field(alias="from")
    goal: str = Field(alias="to")
    via: Annotated[list[str], BeforeValidator(_list)] = []


Several = [BeforeValidator(_list), Field(min_length=1), AfterValidator(_different)]


class _File(BaseModel):
    """The keys of a sweep file, each with what it is where it is left out."""

    model_config = ConfigDict(extra="forbid")
    maps: Annotated[list[str], *Several] = ["millbrook"]
    missions: Annotated[list[str | _Places], *Several] = ["paper"]
    traffic: Annotated[dict[str, Vehicles], BeforeValidator(_densities), Field(min_length=1)] = {"normal": 120}
    algorithms: Annotated[list[str], *Several] = list(ALGORITHMS)
    presets: Annotated[list[str], *Several] = ["tmpud"]
    seeds: Annotated[list[Annotated[int, Field(ge=0)]], BeforeValidator(_seeds), *Several[1:]] = list(range(20))


def read_sweep(file: Path, server: str = "", map_of: Callable[[str], str] = str) -> Grid:
    """Return the grid that a file describes, to be driven on a CARLA server where one is given.

    ``map_of`` returns what a map's name stands for. RequestError names the file and the path of the key that is wrong.
    """
    try:
        content = yaml.safe_load(file.read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        raise RequestError(f"{file}{line}: {getattr(error, 'problem', None) or 'not YAML'}") from error
    except OSError as error:
        raise RequestError(f"{file}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise RequestError(f"{file}: cannot be read as text: {error}") from error
    grid = _grid(file, content)
    grid = replace(grid, server=server, maps=tuple(map(map_of, grid.maps)))
    try:
        cells(grid)
    except TmpudError as error:
        raise RequestError(f"{file}: {error}") from error
    return grid


def _worst(error: ValidationError) -> str:
    """Return the error that lies deepest, with the path of its key; a union's members are not part of the path."""
    worst = max(error.errors(), key=lambda row: len(row["loc"]))
    path = ".".join(str(part) for part in worst["loc"] if part not in ("str", _Places.__name__))
    unknown = worst["type"] == "extra_forbidden"
    hint = f"; keys are {', '.join(_File.model_fields)}" if unknown and len(worst["loc"]) == 1 else ""
    return f"{path}: {'no such key' if unknown else worst['msg']}{hint}"


def _grid(file: Path, content: Any) -> Grid:
    if not isinstance(content, dict):
        raise RequestError(f"{file}: not a mapping; its keys are {', '.join(_File.model_fields)}")
    try:
        asked = _File.model_validate(content)
    except ValidationError as error:
        raise RequestError(f"{file}: {_worst(error)}") from error
    missions = tuple(m if isinstance(m, str) else Route(m.start, m.goal, tuple(m.via)) for m in asked.missions)
    return Grid(
        maps=tuple(asked.maps),
        missions=missions,
        traffic=asked.traffic,
        algorithms=tuple(asked.algorithms),
        presets=tuple(asked.presets),
        seeds=tuple(asked.seeds),
    )
