"""The pages: a list, one page for each run and experiment, and parts of them that are asked for again and again."""

from __future__ import annotations

import asyncio
import hashlib
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response
from starlette.routing import Route

from tmpud.errors import TmpudError
from tmpud.server.index import EXPERIMENT, RUN, Entry, Index, read_file
from tmpud.server.replays import Replays
from tmpud.server.security import REPLAY_POLICY, REPORT_POLICY, Guard
from tmpud.server.summaries import REPORT, Summaries, Summary

PATIENCE = 1.0  # [s] spent on reading what is new before an answer
LARGEST = 50_000_000  # bytes of a report
STATIC = {"view.css": "text/css", "view.js": "text/javascript"}


def make_app(roots: Sequence[Path], port: int, token: str) -> Guard:
    """Return the server's application; all below ``roots`` can be read by who knows the token."""
    pages = _Pages(Index(roots))
    routes = [
        Route("/", pages.list),
        Route("/list", pages.list_part),
        Route("/static/{name}", pages.static),
        Route("/runs/{id}/replay", pages.replay),
        Route("/experiments/{id}/report", pages.report),
        Route("/{kind}/{id}", pages.entry),
        Route("/{kind}/{id}/part", pages.entry_part),
    ]
    app = Starlette(routes=routes)
    app.router.redirect_slashes = False
    return Guard(app, port, token)


class _Pages:
    def __init__(self, index: Index) -> None:
        self._index, self._summaries, self._replays = index, Summaries(), Replays()
        self._templates = Environment(
            loader=PackageLoader("tmpud.server"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
        )
        files = Path(__file__).parent / "static"
        self._static = {name: ((files / name).read_bytes(), kind) for name, kind in STATIC.items()}

    def list(self, _: Request) -> Response:
        return self._page("list.html", self._list())

    def list_part(self, request: Request) -> Response:
        return self._part(request, "list_part.html", self._list())

    def entry(self, request: Request) -> Response:
        return self._page("entry.html", self._entry(request))

    def entry_part(self, request: Request) -> Response:
        return self._part(request, "entry_part.html", self._entry(request))

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
        try:
            page = await self._replays.page(entry.folder)
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

    def _found(self, request: Request, kind: str) -> Entry:
        entry = self._index.get(kind, request.path_params["id"])
        if entry is None:
            raise HTTPException(404, "There is no such run or experiment (any more).")
        return entry

    def _page(self, template: str, told: dict[str, Any]) -> Response:
        return HTMLResponse(self._render(template, {**told, "seen": self._seen(template, told)}))

    def _part(self, request: Request, template: str, told: dict[str, Any]) -> Response:
        """Answer with a part of a page, or with nothing where it is as it was seen."""
        text = self._render(template, told)
        if request.query_params.get("seen") == (seen := _digest(text)):
            return Response(status_code=204)
        return HTMLResponse(text, headers={"X-Seen": seen})

    def _seen(self, template: str, told: dict[str, Any]) -> str:
        return _digest(self._render(template.replace(".html", "_part.html"), told))

    def _render(self, template: str, told: dict[str, Any]) -> str:
        text = self._templates.get_template(template).render(told)
        return text.encode(errors="replace").decode()  # half a surrogate pair has no UTF-8


def _of(rows: Sequence[tuple[Entry, Summary]], kind: str) -> Sequence[tuple[Entry, Summary]]:
    return [row for row in rows if row[0].kind == kind]


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
