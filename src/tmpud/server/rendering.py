"""Pages from templates, and the parts of them that are asked for again and again."""

from __future__ import annotations

import hashlib
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from starlette.requests import Request
from starlette.responses import HTMLResponse, Response


class Templates:
    """All text in them is escaped."""

    def __init__(self) -> None:
        self._templates = Environment(
            loader=PackageLoader("tmpud.server"), autoescape=True, undefined=StrictUndefined, trim_blocks=True
        )

    def page(self, template: str, told: dict[str, Any]) -> Response:
        """Return a page without a part that changes."""
        return HTMLResponse(self._render(template, told))

    def live_page(self, template: str, told: dict[str, Any]) -> Response:
        """Return a page around the part of the same name, which knows what of it was seen."""
        seen = _digest(self._render(template.replace(".html", "_part.html"), told))
        return HTMLResponse(self._render(template, {**told, "seen": seen}))

    def part(self, request: Request, template: str, told: dict[str, Any]) -> Response:
        """Answer with a part of a page, or with nothing where it is as it was seen."""
        text = self._render(template, told)
        if request.query_params.get("seen") == (seen := _digest(text)):
            return Response(status_code=204)
        return HTMLResponse(text, headers={"X-Seen": seen})

    def _render(self, template: str, told: dict[str, Any]) -> str:
        text = self._templates.get_template(template).render(told)
        return text.encode(errors="replace").decode()  # half a surrogate pair has no UTF-8


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
