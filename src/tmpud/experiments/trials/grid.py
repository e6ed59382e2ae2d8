"""A grid of trials in full simulation: every map, mission, density, preset and seed, each driven by all algorithms."""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from itertools import product
from typing import Any, NamedTuple

from tmpud.errors import RequestError
from tmpud.experiments.running.tasks import DONE, Record, Task
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS
from tmpud.experiments.statistics.rows import TrialRow
from tmpud.presets import preset_named
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import RANDOM, request
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.symbols import Place

_ALGORITHM = re.compile(r"(tmpud|no-com)|threshold\((0|1|0?\.\d+|[01]\.\d+)\)")
_RANDOM = re.compile(r"random:([1-9]\d{0,4})")


class Route(NamedTuple):
    """A mission's places, as a user writes them."""

    start: str
    goal: str
    via: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """What to combine; each combination of mission and seed is one trial, the same for all algorithms."""

    maps: tuple[str, ...] = ("millbrook",)
    missions: tuple[str | Route, ...] = ("paper",)  # "paper", "random:N" or places
    traffic: Mapping[str, int] = field(default_factory=lambda: {"normal": 120, "heavy": 200})  # [vehicles]
    algorithms: tuple[str, ...] = ALGORITHMS
    presets: tuple[str, ...] = ("tmpud",)
    seeds: tuple[int, ...] = tuple(range(200))
    server: str = ""  # host:port of a CARLA server, "" where SUMO drives

    def to_json(self) -> dict[str, Any]:
        row = asdict(self)
        return row if self.server else {name: value for name, value in row.items() if name != "server"}

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Grid:
        """Return the grid that ``to_json`` described."""
        routes = (m if isinstance(m, str) else Route(m[0], m[1], tuple(m[2])) for m in row["missions"])
        lists = {name: tuple(row[name]) for name in ("maps", "algorithms", "presets", "seeds")}
        return cls(missions=tuple(routes), traffic=dict(row["traffic"]), server=row.get("server", ""), **lists)


class Cell(NamedTuple):
    """One task, and where its result belongs in a table."""

    condition: str
    algorithm: str
    trial: int
    task: Task


def cells(grid: Grid) -> list[Cell]:
    """Return all trials of a grid; raises MapError or RequestError for what cannot be run."""
    for preset in grid.presets:
        preset_named(preset)
    found = []
    for map_, routes in ((map_, _routes(map_, grid.missions)) for map_ in grid.maps):
        for (name, vehicles), (trial, (route, seed)) in product(
            grid.traffic.items(), enumerate(product(routes, grid.seeds))
        ):
            shared = {"map": map_, "traffic": vehicles, "seed": seed, **route._asdict()}
            shared |= {"server": grid.server} if grid.server else {}
            for preset, algorithm in product(grid.presets, grid.algorithms):
                condition = _condition(grid, map_, name, preset)
                key = f"{condition or name}/{trial:05d}/{algorithm}"
                arguments = {"preset": preset, **_algorithm(algorithm)}
                work = "carla" if grid.server else "full"
                task = Task(key=key, work=work, shared=shared, arguments=arguments)
                found.append(Cell(condition, algorithm, trial, task))
    return found


def rows(grid: Grid, records: Iterable[Record]) -> Iterator[TrialRow]:
    """Yield the trials that have a record, in the grid's order; a fault of the tool is a row of its own status."""
    known = {record.key: record for record in records}
    for cell in cells(grid):
        record = known.get(cell.task.key)
        if record is not None and record.digest == cell.task.digest:
            yield row(cell, record)


def row(cell: Cell, record: Record) -> TrialRow:
    """Return a record as a row of a table."""
    result = dict(record.result)
    done = record.status == DONE
    return TrialRow(
        condition=cell.condition,
        algorithm=cell.algorithm,
        trial=cell.trial,
        status=result.pop("status") if done else record.status,
        distance=result.pop("distance", 0.0),
        unsafe=result.pop("unsafe", False),
        details=result,
    )


def _condition(grid: Grid, map_: str, traffic: str, preset: str) -> str:
    """Return what tells tables apart: the density, and what else the grid varies but the mission and the seed."""
    parts = [traffic]
    parts += [map_] if len(grid.maps) > 1 else []
    parts += [f"preset {preset}"] if len(grid.presets) > 1 else []
    return ", ".join(parts)


def _algorithm(text: str) -> dict[str, Any]:
    """Return the options of ``drive`` that an algorithm's name stands for."""
    found = _ALGORITHM.fullmatch(text)
    if not found:
        raise RequestError(f"no algorithm is called {text!r}; there are tmpud, no-com and threshold(BETA), BETA 0 to 1")
    return {"algorithm": found[1]} if found[1] else {"algorithm": "threshold", "beta": float(found[2])}


def _routes(map_: str, missions: Iterable[str | Route]) -> list[Route]:
    """Return the places of missions on a map; random ones are drawn, the same in every run."""
    network = load_map(map_)
    found: list[Route] = []
    for mission in missions:
        if isinstance(mission, Route):
            request(network, mission.start, (mission.goal,), mission.via)
            found.append(mission)
        elif count := _RANDOM.fullmatch(mission):
            found += [_random_route(network, number) for number in range(int(count[1]))]
        elif mission == "paper" and map_ in PAPER_MISSIONS:
            found.append(Route(PAPER_MISSIONS[map_].start, PAPER_MISSIONS[map_].goal))
        else:
            choices = f"random:N, places (from, to, via), or paper (on {', '.join(PAPER_MISSIONS)})"
            raise RequestError(f"no mission {mission!r} on {map_}: give {choices}")
    return found


def _random_route(network: RoadNetwork, number: int) -> Route:
    seed = random.Random(f"mission/{number}").randrange(2**31)  # noqa: S311
    drawn = request(network, RANDOM, (RANDOM,), seed=seed)
    return Route(_words(network, drawn.start), _words(network, drawn.goals[0]))


def _words(network: RoadNetwork, place: Place) -> str:
    """Return a place as a position that names it again."""
    pose = network.lanes[network.segments[place.segments[0]].lane].centre.pose_at(place.station or 0.0)
    return f"{pose.x:.3f},{pose.y:.3f}"
