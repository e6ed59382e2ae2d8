"""What an experiment's trials come to, counted by the code that also writes its report, in a process of its own."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tmpud.errors import TmpudError
from tmpud.experiments.running.manifest import MANIFEST
from tmpud.experiments.running.store import RESULTS
from tmpud.server import children
from tmpud.server.kept import Kept
from tmpud.server.pareto import Drawn, Point

if TYPE_CHECKING:
    from tmpud.experiments.kinds import Findings
    from tmpud.experiments.statistics.rows import TrialRow

KEPT = 4  # experiments


class Row(NamedTuple):
    """One trial; every text may be hostile."""

    id: str  # for addresses
    key: str  # of its task; empty where it cannot be driven again
    point: int  # its number
    trial: int
    seed: int | None
    mission: str
    traffic: int | None  # vehicles
    status: str
    distance: float  # [m]
    unsafe: bool
    moments: str  # in words
    kept: dict[str, Any]  # all else of its result


@dataclass(frozen=True, slots=True, kw_only=True)
class Counted:
    """An experiment's points, and the trials behind them."""

    title: str
    bars: str  # what they show
    panels: tuple[Drawn, ...]
    points: tuple[Point, ...]
    rows: tuple[Row, ...]
    found: Mapping[str, Row]  # by id


def countings() -> Kept[Path, Counted | None]:
    """Return what counts the trials of results folders; None of those that are not experiments of trials."""
    return Kept(KEPT, lambda folder: _count(folder), lambda folder: children.stamp(folder / RESULTS, folder / MANIFEST))


async def _count(folder: Path) -> Counted | None:
    told = json.loads(await children.said_by(__name__, folder))
    if told is None:
        return None
    rows = tuple(Row(*row) for row in told["rows"])
    return Counted(
        title=told["title"],
        bars=told["bars"],
        panels=tuple(Drawn.from_json(panel) for panel in told["panels"]),
        points=tuple(Point(**point) for point in told["points"]),
        rows=rows,
        found={row.id: row for row in rows},
    )


def main() -> None:
    """Write what the results folder that is named comes to, as JSON, to stdout."""
    from tmpud.experiments.kinds import KINDS, findings
    from tmpud.experiments.running.store import read_results

    (folder,) = children.begin(short=True)
    try:
        results = read_results(Path(folder))
        told = _told(findings(results)) if results.manifest["experiment"] in KINDS else None
    except TmpudError as error:
        sys.exit(str(error))
    json.dump(told, sys.stdout)


def _told(found: Findings) -> dict[str, Any]:
    from tmpud.experiments.reports.charts import label
    from tmpud.server.pareto import draw

    cells = found.analysis.cells
    points = [
        Point(cell.condition, label(cell.algorithm), cell.trials, cell.unsafe, cell.faults, cell.arrived)
        for cell in cells
    ]
    numbers = {(cell.condition, cell.algorithm): number for number, cell in enumerate(cells)}
    return {
        "title": found.kind.title,
        "bars": found.bars,
        "panels": [asdict(panel) for panel in draw(found.panels(), found.kind.reference)],
        "points": [asdict(point) for point in points],
        "rows": list(_rows(found, numbers)),
    }


def _rows(found: Findings, numbers: Mapping[tuple[str, str], int]) -> Iterable[Row]:
    cells = found.kind.cells(found.results.manifest["options"]) if found.kind.cells else []
    tasks = {(cell.condition, cell.algorithm, cell.trial): cell.task for cell in cells}
    for row in found.rows:
        task = tasks.get((row.condition, row.algorithm, row.trial))
        shared = task.shared if task else {}
        places = [shared.get("start"), *shared.get("via", ()), shared.get("goal")]
        key = task.key if task else ""
        yield Row(
            id=sha256(key.encode(errors="replace")).hexdigest()[:16] if key else "",
            key=key,
            point=numbers[row.condition, row.algorithm],
            trial=row.trial,
            seed=shared.get("seed"),
            mission=" → ".join(map(str, places)) if task else "",
            traffic=shared.get("traffic"),
            status=str(row.status),
            distance=row.distance if math.isfinite(row.distance) else 0.0,
            unsafe=bool(row.unsafe),
            moments=_moments(row),
            kept=dict(row.details) if task else {},
        )


def _moments(row: TrialRow) -> str:
    """Say what was unsafe, or at least a collision, in a trial."""
    collisions, stops = row.details.get("collisions", {}), row.details.get("forced_stops", 0)
    words = [f"{n} × {name} collision" for name, n in collisions.items() if n]
    return ", ".join([*words, f"{stops} × forced stop"] if stops else words)


if __name__ == "__main__":
    main()
