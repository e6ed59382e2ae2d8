"""Who is answered, and what an answer may do in a browser."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

PAGE_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; frame-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
REPLAY_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"  # the page itself says which script and style
REPORT_POLICY = (  # a file that anybody may have written: no script at all
    "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class Guard:
    """Answers only who knows the token, asks this very server, and only reads.

    The token is the first part of every path: a cookie would be sent to other servers on this machine, too.
    """

    def __init__(self, app: ASGIApp, port: int, token: str) -> None:
        self._app, self._token = app, token.encode()
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}
        self._origins = {f"http://{host}" for host in self._hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        async def send_guarded(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update(HEADERS)
                headers.setdefault("Content-Security-Policy", PAGE_POLICY)
            await send(message)

        if scope["type"] != "http":
            return
        token, _, path = scope["path"].removeprefix("/").partition("/")
        if refusal := self._refusal(scope, token):
            await refusal(scope, receive, send_guarded)
        else:
            await self._app({**scope, "path": f"/{path}", "raw_path": b""}, receive, send_guarded)

    def _refusal(self, scope: Scope, token: str) -> PlainTextResponse | None:
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        if len(hosts) != 1 or hosts[0] not in self._hosts or not self._origins.issuperset(headers.getlist("origin")):
            return PlainTextResponse("This server answers on its own address only.", 403)
        if not secrets.compare_digest(token.encode(errors="replace"), self._token):
            return PlainTextResponse("The token is missing: use the whole address that tmpud view printed.", 403)
        if scope["method"] not in ("GET", "HEAD"):
            return PlainTextResponse("This server only shows.", 405, {"Allow": "GET, HEAD"})
        return None
