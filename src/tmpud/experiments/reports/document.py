"""A report of an experiment as ``report.md`` and as a self-contained ``report.html``, with its pictures beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tmpud.experiments.reports.table import Table, without_repeats


@dataclass(frozen=True, slots=True)
class Picture:
    """A chart in both formats."""

    name: str  # of its files, without suffix
    caption: str
    svg: str  # a whole SVG document of our own making: it is put into the page as it is
    png: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A heading with what stands under it."""

    title: str
    lines: tuple[str, ...] = ()  # list items
    pictures: tuple[Picture, ...] = ()
    table: Table | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """Plain data; every text may be hostile, none is read as markup."""

    title: str
    command: str  # that repeats it
    run: Mapping[str, str]  # versions, hashes, date
    sections: tuple[Section, ...]


def write_report(folder: Path, report: Report) -> tuple[Path, ...]:
    """Write a report and its pictures into a folder, which is made where it is missing; return the files."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name in ("report.md", "report.html"):
        # a name may hold half a surrogate pair, which has no UTF-8
        (folder / name).write_bytes(render(name, report).encode(errors="replace"))
        written.append(folder / name)
    for picture in (picture for section in report.sections for picture in section.pictures):
        svg, png = folder / f"{picture.name}.svg", folder / f"{picture.name}.png"
        svg.write_text(picture.svg, encoding="utf-8")
        png.write_bytes(picture.png)
        written += [svg, png]
    return tuple(written)


def render(template: str, report: Report) -> str:
    """Return a report as "report.md" or "report.html"."""
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
    from markupsafe import Markup

    environment = Environment(
        loader=PackageLoader("tmpud.experiments.reports"),
        autoescape=select_autoescape(["html"]),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["markdown"] = as_markdown
    environment.filters["without_repeats"] = without_repeats
    environment.filters["drawing"] = lambda picture: Markup(_element(picture.svg))  # noqa: S704 - drawn by us
    return environment.get_template(template).render(report=report)


def as_markdown(text: str) -> str:
    """Return text that Markdown shows as it is, within a line."""
    shown = " ".join(text.split()).replace("\\", "\\\\").replace("&", "&amp;").replace("<", "&lt;")
    for letter in "`*|#":
        shown = shown.replace(letter, f"\\{letter}")
    return shown.replace("](", "]\\(")


def _element(svg: str) -> str:
    """Return an SVG document's one element, without what stands before it."""
    return svg[svg.index("<svg") :]
