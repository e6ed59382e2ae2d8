"""The pages: a list, one page for each run and experiment, and parts of them that are asked for again and again."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route

from tmpud.errors import TmpudError
from tmpud.server.index import EXPERIMENT, RUN, Entry, Index, read_file
from tmpud.server.pairs import pair_of, side_of
from tmpud.server.rendering import Templates
from tmpud.server.replays import replays
from tmpud.server.security import REPLAY_POLICY, REPORT_POLICY, Guard
from tmpud.server.summaries import REPORT, Summaries, Summary
from tmpud.server.trial_pages import TrialPages

PATIENCE = 1.0  # [s] spent on reading what is new before an answer
LARGEST = 50_000_000  # bytes of a report
BESIDE = 12  # runs to which one can be compared at a click
STATIC = {"view.css": "text/css", "view.js": "text/javascript"}


def make_app(roots: Sequence[Path], port: int, token: str) -> Guard:
    """Return the server's application; all below ``roots`` can be read by who knows the token."""
    index, templates = Index(roots), Templates()
    pages = _Pages(index, templates)
    routes = [
        Route("/", pages.list),
        Route("/list", pages.list_part),
        Route("/static/{name}", pages.static),
        Route("/runs/{id}/replay", pages.replay),
        Route("/runs/{id}/with/{other}", pages.pair),
        Route("/runs/{id}/with/{other}/part", pages.pair_part),
        Route("/runs/{id}/with/{other}/replay", pages.pair_replay),
        Route("/experiments/{id}/report", pages.report),
        *TrialPages(index, templates, pages.show).routes(),
        Route("/{kind}/{id}", pages.entry),
        Route("/{kind}/{id}/part", pages.entry_part),
    ]
    app = Starlette(routes=routes)
    app.router.redirect_slashes = False
    return Guard(app, port, token)


class _Pages:
    def __init__(self, index: Index, templates: Templates) -> None:
        self._index, self._templates = index, templates
        self._summaries, self._replays = Summaries(), replays()
        files = Path(__file__).parent / "static"
        self._static = {name: ((files / name).read_bytes(), kind) for name, kind in STATIC.items()}

    def list(self, _: Request) -> Response:
        return self._templates.live_page("list.html", self._list())

    def list_part(self, request: Request) -> Response:
        return self._templates.part(request, "list_part.html", self._list())

    def entry(self, request: Request) -> Response:
        told = self._entry(request)
        return self._templates.live_page("entry.html", {**told, "others": self._beside(told["entry"], told["summary"])})

    def entry_part(self, request: Request) -> Response:
        return self._templates.part(request, "entry_part.html", self._entry(request))

    def static(self, request: Request) -> Response:
        if (file := self._static.get(request.path_params["name"])) is None:
            raise HTTPException(404)
        return Response(file[0], media_type=file[1])

    def report(self, request: Request) -> Response:
        try:
            page = read_file(self._found(request, EXPERIMENT).folder / REPORT, LARGEST)
        except TmpudError as error:
            raise HTTPException(404, str(error)) from error
        return HTMLResponse(page, headers={"Content-Security-Policy": REPORT_POLICY})

    async def replay(self, request: Request) -> Response:
        entry = await run_in_threadpool(self._found, request, RUN)
        return await self.show(entry.folder)

    def pair(self, request: Request) -> Response:
        return self._templates.live_page("pair.html", self._pair(request))

    def pair_part(self, request: Request) -> Response:
        return self._templates.part(request, "pair_part.html", self._pair(request))

    async def pair_replay(self, request: Request) -> Response:
        entries = [await run_in_threadpool(self._found, request, RUN, name) for name in ("id", "other")]
        return await self.show(*(entry.folder for entry in entries))

    async def show(self, *folders: Path) -> Response:
        """Answer with the replay of a run folder, or of two in step."""
        try:
            page = await self._replays.of(folders)
        except TmpudError as error:
            raise HTTPException(404, str(error)) from error
        except asyncio.CancelledError:  # the server ends
            return Response(status_code=503)
        return HTMLResponse(page, headers={"Content-Security-Policy": REPLAY_POLICY})

    def _list(self) -> dict[str, Any]:
        until = time.monotonic() + PATIENCE
        rows = [(entry, self._summaries.of(entry, until)) for entry in self._index.entries()]
        rows.sort(key=lambda row: (row[1].changed, row[0].name), reverse=True)
        return {"root": "", "part": "list", "sections": [(kind, _of(rows, kind)) for kind in (RUN, EXPERIMENT)]}

    def _entry(self, request: Request) -> dict[str, Any]:
        entry = self._found(request, request.path_params["kind"])
        summary = self._summaries.of(entry, time.monotonic() + PATIENCE)
        return {"root": "../", "part": f"{entry.id}/part", "entry": entry, "summary": summary}

    def _beside(self, entry: Entry, summary: Summary) -> Sequence[tuple[Entry, Summary]]:
        """Return the other runs on a run's map: those in the same traffic first, then the last changed."""
        if not summary.town:
            return []
        until = time.monotonic() + PATIENCE
        runs = [other for other in self._index.entries() if other.kind == RUN and other.id != entry.id]
        rows = [(other, self._summaries.of(other, until)) for other in runs]
        alike = [row for row in rows if row[1].town == summary.town]
        alike.sort(key=lambda row: row[1].changed, reverse=True)
        return sorted(alike, key=lambda row: row[1].traffic != summary.traffic)[:BESIDE]

    def _pair(self, request: Request) -> dict[str, Any]:
        entries = [self._found(request, RUN, name) for name in ("id", "other")]
        until = time.monotonic() + PATIENCE
        sides = [side_of(entry.id, entry.name, self._summaries.of(entry, until)) for entry in entries]
        return pair_of("../../../", [("../../../", "All runs and experiments")], sides)

    def _found(self, request: Request, kind: str, name: str = "id") -> Entry:
        entry = self._index.get(kind, request.path_params[name])
        if entry is None:
            raise HTTPException(404, "There is no such run or experiment (any more).")
        return entry


def _of(rows: Sequence[tuple[Entry, Summary]], kind: str) -> Sequence[tuple[Entry, Summary]]:
    return [row for row in rows if row[0].kind == kind]
