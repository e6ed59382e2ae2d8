import base64
import gzip
import hashlib
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import SHARES, decision, events, frame, header, recorded
from tmpud.events import Estimated, Event
from tmpud.viewer.replay import render, write_replay


def page_of(tmp_path: Path, log: list[Any] | None = None) -> str:
    file = tmp_path / "pages" / "replay.html"
    write_replay(recorded(tmp_path / "run", log), file)
    return file.read_text(encoding="utf-8")


def document_in(page: str) -> Any:
    (packed,) = re.findall(r'id="run">([A-Za-z0-9+/=]+)</script>', page)
    return json.loads(gzip.decompress(base64.b64decode(packed)))


class Elements(HTMLParser):
    """Collects a page's elements with their attributes."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[tuple[str, tuple[tuple[str, str | None], ...]]] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, tuple(attrs)))


def test_the_same_run_gives_the_same_page(tmp_path: Path) -> None:
    assert page_of(tmp_path) == page_of(tmp_path)


def test_the_page_asks_for_nothing(tmp_path: Path) -> None:
    page = page_of(tmp_path)
    named = {name for _, attributes in Elements(page).found for name, _ in attributes}
    assert not named & {"src", "href", "action", "data", "srcset", "style", "onload", "onclick"}
    assert not re.search(r"url\(|@import|importScripts|XMLHttpRequest|\bfetch\(|WebSocket|\beval\(|innerHTML", page)


def test_the_policy_allows_the_pages_own_script_and_style_and_nothing_else(tmp_path: Path) -> None:
    page = page_of(tmp_path)
    policy = next(
        dict(a)["content"] for tag, a in Elements(page).found if ("http-equiv", "Content-Security-Policy") in a
    )
    parts = dict(part.strip().split(" ", 1) for part in str(policy).split(";"))
    assert parts.pop("default-src") == parts.pop("base-uri") == parts.pop("form-action") == "'none'"
    for name, kind in (("script-src", "script"), ("style-src", "style")):
        (text,) = re.findall(rf"<{kind}>(.*?)</{kind}>", page, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert parts.pop(name) == f"'sha256-{digest}'"
    assert parts == {}


def test_there_are_fifty_hostile_names() -> None:
    assert len(set(NAMES)) == 50


@pytest.mark.parametrize("name", NAMES, ids=range(len(NAMES)))
def test_a_hostile_name_stays_data(name: str) -> None:
    harmless, hostile = (render({"schema": 1, "mission": {"start": text}, text: [text]}) for text in ("name", name))
    assert Elements(hostile).found == Elements(harmless).found
    assert document_in(hostile)["mission"] == {"start": name}


def test_hostile_names_everywhere_in_a_run_stay_data(tmp_path: Path) -> None:
    names = [name.encode(errors="replace").decode() for name in NAMES]
    log = [header(start=names[0], goal=names[1]), *decision(names[2]), frame(0, names, {name: name for name in names})]
    page = page_of(tmp_path, log)
    assert Elements(page).found == Elements(page_of(tmp_path)).found
    assert {car[0] for car in document_in(page)["seen"]["cars"]} == set(names)


def test_the_document_tells_the_run(tmp_path: Path) -> None:
    document = document_in(page_of(tmp_path))
    assert document["mission"]["start"] == "park1e_0"
    assert len(document["seen"]["times"]) == sum(type(event).__name__ == "Frame" for event in events())
    assert document["changes"][0]["rows"][0]["role"] == "chosen"
    assert document["judged"][0]["blame"] == "ego"


def test_the_document_tells_what_an_estimate_was_made_of(tmp_path: Path) -> None:
    document = document_in(page_of(tmp_path))
    (found,) = document["estimates"]
    assert document["controls"] == {
        "acceleration": [-6.0, 3.0], "turning": [-0.1, 0.1], "steering": True, "aggregate": "min+mean",
    }  # fmt: skip
    assert found["o"] == [list(row) for row in SHARES]
    assert found["planes"][0][:2] == [None, [-1.5, 1.0, 5.0]]
    assert found["others"][0] == [4200, 29745, 225, 0, 225, 0, 225, 0, 225, 0]  # 9 m/s straight on


def estimated(**values: Any) -> list[Event]:
    """Return the run with another estimate."""
    return [replace(event, **values) if isinstance(event, Estimated) else event for event in events()]


def test_where_no_control_is_safe_the_limit_is_one_that_nothing_meets(tmp_path: Path) -> None:
    planes = ((None, (-math.inf, 0.0, 0.0), None, None, None), (None,) * 5)
    (found,) = document_in(page_of(tmp_path, estimated(planes=planes)))["estimates"]
    assert found["planes"][0][:2] == [None, [-1e9, 0.0, 0.0]]


def test_a_log_of_schema_1_is_shown_without_the_sets(tmp_path: Path) -> None:
    document = document_in(page_of(tmp_path, estimated(others=(), planes=())))
    assert document["missing"] == []
    assert (document["estimates"][0]["planes"], document["estimates"][0]["others"]) == ([], [])


@pytest.mark.parametrize(
    "values",
    [
        {"planes": (((0.0, 1.0, 1.0),),)},
        {"planes": ((None,) * 5, (None, None, None, None, (math.nan, 0.0, 0.0)))},
        {"planes": ((None,) * 5, (None, None, None, None, (0.0, 0.0)))},
        {"others": ((0.0, 0.0, 0.0, 0.0, 0.0),)},
        {"others": ((1e300, 0.0, 0.0, 1e300, 0.0), (0.0,) * 5)},
    ],
)
def test_sets_that_do_not_fit_the_shares_are_damage(tmp_path: Path, values: dict[str, Any]) -> None:
    document = document_in(page_of(tmp_path, estimated(**values)))
    assert document["estimates"] == []
    assert any("damaged" in told for told in document["missing"])
