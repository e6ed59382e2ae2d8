"""The pages in ``docs`` cannot go stale: names, values, fields, examples and links are compared with the code."""

from __future__ import annotations

import importlib
import json
import math
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

import tmpud.events
from tmpud.events import Event, from_json, to_json
from tmpud.judging.rules import Kind
from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
from tmpud.runner import STATUS
from tmpud.scene import Outcome

ROOT = Path(__file__).resolve().parents[2]
PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
KINDS = [kind for kind in vars(tmpud.events).values() if isinstance(kind, type) and Event in kind.__mro__[1:]]


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text()


def section(title: str) -> str:
    return page("events.md").partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def resolved(name: str) -> Any:
    """Return what a dotted name stands for."""
    parts = name.split(".")
    for end in range(len(parts), 0, -1):
        try:
            found: Any = importlib.import_module(".".join(parts[:end]))
        except ModuleNotFoundError:
            continue
        for part in parts[end:]:
            found = getattr(found, part)
        return found
    raise AttributeError(name)


@pytest.mark.parametrize("file", PAGES, ids=lambda file: file.name)
def test_every_name_of_the_package_exists(file: Path) -> None:
    for name in re.findall(r"`(tmpud(?:\.\w+)+)[`(]", file.read_text()):
        resolved(name)


@pytest.mark.parametrize("file", PAGES, ids=lambda file: file.name)
def test_every_link_to_a_file_leads_somewhere(file: Path) -> None:
    for link in re.findall(r"\]\((?!https?:|#)([^)#]+)", file.read_text()):
        assert (file.parent / link).exists(), link


def test_every_preset_field_has_its_row_and_its_values() -> None:
    rows = [line.split(" | ") for line in page("paper-to-code.md").splitlines() if re.match(r"\| `\w+` \| ", line)]
    assert [row[0].strip("| `") for row in rows] == [f.name for f in fields(Preset) if f.name != "name"]
    for row in rows:
        name = row[0].strip("| `")
        for preset, cell in zip((TMPUD, PAPER, RELEASED), row[1:4], strict=True):
            assert cell == shown(name, getattr(preset, name)), f"{name} of {preset.name}"


def shown(name: str, value: Any) -> str:
    """Return a preset's value as the page writes it."""
    if name == "neighbour_heading":
        return f"{math.degrees(value):.0f}°"
    if name == "ego_speeds":
        return " and ".join(f"{speed * 3.6:.0f}" for speed in value) + " km/h" if value else "planned"
    if value is None:
        return {"horizon": "until x'", "safe_expires": "never"}[name]
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return " to ".join(f"{end:g}" for end in value)
    return value if isinstance(value, str) else f"{value:g}"


def test_every_kind_of_event_has_its_section() -> None:
    assert re.findall(r"^## (\w+)$", page("events.md"), re.MULTILINE) == [kind.__name__ for kind in KINDS]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_an_events_fields_are_those_of_the_code(kind: type[Event]) -> None:
    assert re.findall(r"^\| `(\w+)` \|", section(kind.__name__), re.MULTILINE) == [f.name for f in fields(kind)]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_an_events_example_can_be_read_and_written_again(kind: type[Event]) -> None:
    example = json.loads(section(kind.__name__).partition("```json\n")[2].partition("\n```")[0])
    event = from_json(example)
    assert type(event) is kind
    assert json.loads(json.dumps(to_json(event))) == example
    assert list(to_json(event)) == list(example)


def test_all_that_a_field_can_hold_is_named() -> None:
    assert all(status in section("Finished") for status in {*STATUS.values(), "NO_PLAN"})
    assert all(outcome.value in section("Executed") for outcome in Outcome)
    assert all(kind.value in section("Judged") for kind in Kind)
