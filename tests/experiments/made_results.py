"""A results folder of a sweep in which nothing was driven: what came of each trial is made up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.store import Store
from tmpud.experiments.running.tasks import DONE, Record
from tmpud.experiments.trials.grid import Cell, Grid, Route, cells

GRID = Grid(
    missions=(Route("park1e_0", "park2e_1"),),
    traffic={"normal": 3, "heavy": 6},
    algorithms=("tmpud", "no-com"),
    seeds=tuple(range(5)),
)


def result(cell: Cell) -> dict[str, Any]:
    """Return a trial's result: of no-com, every second is unsafe."""
    unsafe = cell.algorithm == "no-com" and cell.trial % 2 == 1
    longer = 10 * (cell.algorithm == "tmpud")
    return {
        "status": "COLLISION" if unsafe else "SUCCESS",
        "message": "",
        "distance": 100.0 + longer + cell.trial,
        "travel_time": 20.0,
        "unsafe": unsafe,
        "collisions": {"merge": 1} if unsafe else {},
        "forced_stops": 0,
    }


def made_results(
    folder: Path, grid: Grid = GRID, make: Callable[[Cell], dict[str, Any]] = result, status: str = DONE
) -> Path:
    found = cells(grid)
    experiment = Experiment(name="sweep", options=grid.to_json(), command="tmpud sweep it.yaml")
    with Store(folder, experiment, [cell.task for cell in found]) as store:
        store.append(
            Record(key=cell.task.key, digest=cell.task.digest, status=status, result=make(cell)) for cell in found
        )
    return folder
