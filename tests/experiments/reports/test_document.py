import json
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from markdown_it import MarkdownIt

from tests.experiments.planted import planted, row
from tmpud.experiments.reports.analysis import Analysis, analyse, report
from tmpud.experiments.reports.charts import draw, interval_panels
from tmpud.experiments.reports.document import Report, Section, as_markdown, render, write_report
from tmpud.experiments.reports.table import Table
from tmpud.experiments.statistics.paper_numbers import TABLE1
from tmpud.experiments.statistics.rows import TrialRow

HOSTILE = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "[x](javascript:alert(1))",
    "![x](http://example.org/x.png)",
    "a | b\n\n# c `d` **e** </table>",
    "{{ report.title }}{% raw %}",
    "&lt;b&gt; \\<i> half a pair \ud800",
)


class Page(HTMLParser):
    """What a page is made of."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.attributes: list[tuple[str, str | None]] = []
        self.words: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes += attrs

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def analysed(rows: list[TrialRow]) -> Analysis:
    return analyse(rows, TABLE1, np.random.default_rng(0), resamples=300)


def written(rows: list[TrialRow], folder: Path, **others: str) -> Report:
    analysis = analysed(rows)
    pictures = [draw(interval_panels(analysis.cells), TABLE1, "table1", others.get("caption", "Distance and safety"))]
    words = {"title": "Table I", "command": "tmpud paper table1", **others}
    made = report(
        analysis,
        title=words["title"],
        command=words["command"],
        run={words.get("key", "results"): words.get("value", "0123456789abcdef")},
        pictures=pictures,
        deviations=[words.get("deviation", "SUMO instead of CARLA.")],
    )
    write_report(folder, made)
    return made


def test_both_formats_say_what_was_run_what_came_out_and_what_is_different(tmp_path: Path) -> None:
    made = written([*planted(60, seed=1), row("tmpud", 60, status="SIM_CRASH")], tmp_path)
    markdown = (tmp_path / "report.md").read_text()
    page = Page((tmp_path / "report.html").read_text()).text
    rendered = Page(MarkdownIt("commonmark").enable("table").render(markdown)).text
    for text in (page, rendered):
        for expected in ("tmpud paper table1", "0123456789abcdef", "SUMO instead of CARLA.", "SIM_CRASH (tool fault)"):
            assert expected in text
        for section in made.sections:
            assert section.title in text
            for line in section.table.rows if section.table else ():
                assert all(cell in text for cell in line)


def test_the_files_are_there_and_named(tmp_path: Path) -> None:
    written(planted(30, seed=2), tmp_path / "new" / "folder")
    names = {file.name for file in (tmp_path / "new" / "folder").iterdir()}
    assert names == {"report.md", "report.html", "table1.svg", "table1.png"}
    (link,) = re.findall(r"!\[.*\]\((.*)\)", (tmp_path / "new" / "folder" / "report.md").read_text())
    assert link in names


def test_the_page_is_self_contained_and_may_load_nothing(tmp_path: Path) -> None:
    written(planted(30, seed=3), tmp_path)
    page = Page((tmp_path / "report.html").read_text())
    assert "svg" in page.tags
    assert not page.tags & {"script", "link", "img", "iframe", "object"}
    loaded = [value for name, value in page.attributes if name in ("src", "href", "xlink:href", "action")]
    assert all(value is not None and value.startswith("#") for value in loaded)
    assert ("content", "default-src 'none'; style-src 'unsafe-inline'") in page.attributes


def pages(folder: Path) -> tuple[Page, Page]:
    """Return both of a folder's reports as a browser sees them, Markdown with HTML allowed."""
    rendered = MarkdownIt("commonmark", {"html": True}).enable("table").render((folder / "report.md").read_text())
    return Page((folder / "report.html").read_text()), Page(rendered)


@pytest.fixture(scope="module")
def harmless(tmp_path_factory: pytest.TempPathFactory) -> tuple[Page, Page]:
    folder = tmp_path_factory.mktemp("harmless")
    written([row(name, trial, condition="x") for name in ("y", "tmpud") for trial in range(3)], folder)
    return pages(folder)


@pytest.mark.parametrize("hostile", HOSTILE)
def test_nothing_in_a_name_becomes_markup(hostile: str, tmp_path: Path, harmless: tuple[Page, Page]) -> None:
    rows = [row(name, trial, condition=hostile) for name in (hostile, "tmpud") for trial in range(3)]
    rows += [row("tmpud", 3, condition=hostile, status=hostile)]
    written(rows, tmp_path, **dict.fromkeys(("title", "command", "key", "value", "deviation", "caption"), hostile))
    for found, expected in zip(pages(tmp_path), harmless, strict=True):
        assert found.tags == expected.tags
        assert {name for name, _ in found.attributes} == {name for name, _ in expected.attributes}
        assert " ".join(hostile.replace("\ud800", "?").split()) in found.text
    _, rendered = pages(tmp_path)
    assert [value for name, value in rendered.attributes if name in ("src", "href")] == ["table1.svg"]


@pytest.mark.parametrize("text", [*HOSTILE[:6], "a_b", "[1.0, 2.0]", "Th(0.5)", "x](y)"])
def test_markdown_shows_text_as_it_is_on_one_line(text: str) -> None:
    shown = Page(MarkdownIt("commonmark", {"html": True}).render(f"- {as_markdown(text)}")).text
    assert shown == " ".join(text.split())
    assert "\n" not in as_markdown(text)


def test_a_section_without_anything_is_left_out_and_a_report_needs_no_picture() -> None:
    analysis = analysed([row("other", 0, condition="mine")])
    made = report(analysis, title="Sweep", command="tmpud sweep x.yaml", run={})
    assert [section.title for section in made.sections] == ["Results", "How the trials ended"]
    assert "<svg" not in render("report.html", made)


def test_a_report_of_any_tables_can_be_written() -> None:
    table = Table("Areas under curves", ("estimate", "verdict"), (("gap", "not seen"),), ("a note",))
    made = Report(title="Calibration", command="x", run={}, sections=(Section(title="Areas", table=table),))
    page = render("report.html", made)
    assert 'class="not-seen"' in page
    assert "a note" in page


def test_an_analysis_is_json_and_does_not_depend_on_the_order_of_rows() -> None:
    rows = planted(40, seed=4)
    words = json.loads(json.dumps(analysed(rows).to_json(), allow_nan=False))
    assert words == json.loads(json.dumps(analysed(rows[::-1]).to_json()))
    assert words["cells"][0]["paper"] == {"distance": 514, "per_1000": 0}
    assert len(words["claims"]) == 15
