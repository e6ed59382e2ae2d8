"""An experiment's results: its points, the trials behind a point, and a trial driven again for its replay."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from tmpud.errors import TmpudError
from tmpud.experiments.running.tasks import digest
from tmpud.server.counting import Counted, Row, countings
from tmpud.server.index import EXPERIMENT, Entry, Index
from tmpud.server.pairs import Side, pair_of
from tmpud.server.pareto import HEIGHT, WIDTH, Point
from tmpud.server.redriving import Drive, Redrives
from tmpud.server.rendering import Templates
from tmpud.server.summaries import BROKEN, ENDED, WRITTEN

MOST = 500  # trials on a page
SORTS: dict[str, Callable[[Row], Any]] = {
    "unsafe first": lambda row: (not row.unsafe, row.status == "SUCCESS", row.trial),
    "trial": lambda row: row.trial,
    "status": lambda row: (row.status, row.trial),
    "longest first": lambda row: (-row.distance, row.trial),
    "shortest first": lambda row: (row.distance, row.trial),
}
SHOWN: dict[str, Callable[[Row], bool]] = {
    "all": lambda row: True,  # noqa: ARG005
    "unsafe": lambda row: row.unsafe,
    "not arrived": lambda row: row.status != "SUCCESS",
}


class TrialPages:
    def __init__(self, index: Index, templates: Templates, show: Callable[..., Any]) -> None:
        """``show`` answers with the replay of a run folder, or of two in step."""
        self._index, self._templates, self._show = index, templates, show
        self._counted, self._drives = countings(), Redrives()

    def routes(self) -> list[Route]:
        return [
            Route("/experiments/{id}/points", self.points),
            Route("/experiments/{id}/points/{point}", self.point),
            Route("/experiments/{id}/trials/{trial}", self.trial),
            Route("/experiments/{id}/trials/{trial}/part", self.trial_part),
            Route("/experiments/{id}/trials/{trial}/replay", self.replay),
            Route("/experiments/{id}/trials/{trial}/with/{other}", self.pair),
            Route("/experiments/{id}/trials/{trial}/with/{other}/part", self.pair_part),
            Route("/experiments/{id}/trials/{trial}/with/{other}/replay", self.pair_replay),
        ]

    async def points(self, request: Request) -> Response:
        """Answer with the picture, or with nothing where the experiment is not one of trials."""
        entry = await self._entry(request)
        told = {"entry": entry, "width": WIDTH, "height": HEIGHT, "counted": None, "failure": ""}
        try:
            counted = await self._count(entry)
        except TmpudError as error:
            return self._templates.page("points.html", {**told, "failure": str(error)})
        return self._templates.page("points.html", {**told, "counted": counted}) if counted else Response("")

    async def point(self, request: Request) -> Response:
        entry, counted = await self._counts(request)
        number = request.path_params["point"]
        if not (number.isascii() and number.isdigit()) or len(number) > 9 or int(number) >= len(counted.points):
            raise HTTPException(404, "There is no such point.")
        asked = {name: request.query_params.get(name) for name in ("sort", "show", "page")}
        table = _table([row for row in counted.rows if row.point == int(number)], asked)
        told = {"entry": entry, "counted": counted, "number": int(number), "point": counted.points[int(number)]}
        return self._templates.page("point.html", {"root": "../../../", **told, **table})

    async def trial(self, request: Request) -> Response:
        return self._templates.live_page("trial.html", await self._trial(request))

    async def trial_part(self, request: Request) -> Response:
        return self._templates.part(request, "trial_part.html", await self._trial(request))

    async def replay(self, request: Request) -> Any:
        told = await self._trial(request)
        if not told["drive"].there:
            raise HTTPException(404, "This trial has not been driven again yet.")
        return await self._show(told["drive"].folder)

    async def pair(self, request: Request) -> Response:
        return self._templates.live_page("pair.html", _pair(*await self._both(request)))

    async def pair_part(self, request: Request) -> Response:
        return self._templates.part(request, "pair_part.html", _pair(*await self._both(request)))

    async def pair_replay(self, request: Request) -> Any:
        drives = [told["drive"] for told in await self._both(request)]
        if not all(drive.there for drive in drives):
            raise HTTPException(404, "These trials have not both been driven again yet.")
        return await self._show(*(drive.folder for drive in drives))

    async def _both(self, request: Request) -> list[dict[str, Any]]:
        """Return the same trial as two algorithms drove it."""
        _, counted = await self._counts(request)
        one, other = (counted.found.get(request.path_params[name]) for name in ("trial", "other"))
        if one is None or other is None or other not in (row for _, row in _same_trial(counted, one)):
            raise HTTPException(404, "There are no such two trials of the same traffic.")
        return [await self._trial(request, name) for name in ("trial", "other")]

    async def _trial(self, request: Request, name: str = "trial") -> dict[str, Any]:
        entry, counted = await self._counts(request)
        if (row := counted.found.get(request.path_params[name])) is None or not row.key:
            raise HTTPException(404, "There is no such trial, or it cannot be driven again.")
        drive: Drive = self._drives.of(entry.folder, row.key, digest([*row]))
        others = _same_trial(counted, row)
        told = {"entry": entry, "point": counted.points[row.point], "row": row, "drive": drive, "others": others}
        return {"root": "../../../", "part": f"{row.id}/part", **told}

    async def _counts(self, request: Request) -> tuple[Entry, Counted]:
        entry = await self._entry(request)
        try:
            counted = await self._count(entry)
        except TmpudError as error:
            raise HTTPException(404, str(error)) from error
        if counted is None:
            raise HTTPException(404, "This is no experiment of trials.")
        return entry, counted

    async def _count(self, entry: Entry) -> Counted | None:
        try:
            return await self._counted.of(entry.folder)
        except asyncio.CancelledError as error:  # the server ends
            raise HTTPException(503) from error

    async def _entry(self, request: Request) -> Entry:
        entry = await run_in_threadpool(self._index.get, EXPERIMENT, request.path_params["id"])
        if entry is None:
            raise HTTPException(404, "There is no such experiment (any more).")
        return entry


def _same_trial(counted: Counted, row: Row) -> list[tuple[str, Row]]:
    """Return a trial as each algorithm drove it, itself included."""
    here = counted.points[row.point].condition
    return [
        (counted.points[other.point].algorithm, other)
        for other in counted.rows
        if other.trial == row.trial and counted.points[other.point].condition == here and other.key
    ]


def _pair(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return what the page of two trials is told."""
    back = [(f"../../../../{one['entry'].id}", one["entry"].name)]
    return pair_of("../../../../../", back, [_side(**trial) for trial in (one, other)])


def _side(row: Row, point: Point, drive: Drive, **_: object) -> Side:
    """Return a trial as one side, and how far it is where it is being driven again."""
    name = f"trial {row.trial}, {point.algorithm}"
    if drive.phase == "failed":
        return Side(row.id, name, BROKEN, "cannot be driven again", drive.failure, shown=False)
    about = f"{row.distance:.1f} m; {row.moments or 'nothing unsafe'}"
    if drive.there:
        about += "; driven again, it is not the same as what was kept" if drive.differences else ""
        return Side(row.id, name, BROKEN if row.unsafe else ENDED, row.status, about, shown=True, version=drive.phase)
    far = f"is driven again: {100 * drive.share:.0f} %" if drive.phase == "driving" else "will be driven again"
    return Side(row.id, name, WRITTEN, far, about, shown=False)


def _table(rows: Sequence[Row], asked: dict[str, str | None]) -> dict[str, Any]:
    """Return the trials to show, sorted, and the choices; what nobody offered is taken for the usual."""
    sort = asked["sort"] if asked["sort"] in SORTS else next(iter(SORTS))
    show = asked["show"] if asked["show"] in SHOWN else next(iter(SHOWN))
    counts = {name: sum(map(wanted, rows)) for name, wanted in SHOWN.items()}
    chosen = sorted(filter(SHOWN[str(show)], rows), key=SORTS[str(sort)])
    pages = max(1, -(-len(chosen) // MOST))
    text = asked["page"] or ""
    page = min(int(text), pages) if text.isascii() and text.isdigit() and len(text) < 9 and int(text) else 1
    return {
        "rows": chosen[(page - 1) * MOST : page * MOST],
        "sort": sort,
        "show": show,
        "sorts": list(SORTS),
        "counts": counts,
        "page": page,
        "pages": pages,
    }
