"""The replay: one HTML file that plays a run, opens from disk and asks no network for anything.

Nothing of the run is markup: the whole document is gzipped and in base64, and the page's script shows it as text. The
page's content policy allows its own script and style, by their digests, and nothing else.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import re
from pathlib import Path
from typing import Any

from tmpud.viewer.comparison import comparison_document
from tmpud.viewer.document import replay_document
from tmpud.viewer.intact import read_intact

_PAGE = Path(__file__).parent / "page"


def write_replay(folder: Path, file: Path) -> list[str]:
    """Write the replay of a run folder; return what is missing in it. Raises RunFileError."""
    run = read_intact(folder)
    _write(render(replay_document(run)), file)
    return run.missing


def write_comparison(first: Path, second: Path, file: Path) -> list[str]:
    """Write the replay of two runs in one page; return what is missing in it. Raises RunFileError, RequestError."""
    runs = read_intact(first), read_intact(second)
    _write(render(comparison_document(*runs)), file)
    return [f"{folder}: {line}" for folder, run in zip((first, second), runs, strict=True) for line in run.missing]


def render(document: dict[str, Any]) -> str:
    """Return the page that shows a document; the same document gives the same page."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False)  # ASCII: half surrogate pairs are harmless
    packed = base64.b64encode(gzip.compress(text.encode(), 9, mtime=0)).decode()
    script, style = ((_PAGE / name).read_text(encoding="utf-8") for name in ("replay.js", "replay.css"))
    parts = {"script": script, "style": style, "run": packed, "policy": _policy(script, style)}
    template = (_PAGE / "replay.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], template)


def _write(page: str, file: Path) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(page, encoding="utf-8")


def _policy(script: str, style: str) -> str:
    return (
        f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; "
        "base-uri 'none'; form-action 'none'"
    )


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
