"""What notebooks are shown is well-formed, holds what it should, and nothing of it is markup that came from a name."""

from __future__ import annotations

import xml.etree.ElementTree as ET  # of our own making
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from tests.viewer.hostile import NAMES
from tests.viewer.made_results import PROBLEM, REPORT, estimate
from tests.viewer.made_runs import MERGE_NOW, decision
from tmpud.events import Planned
from tmpud.symbols import State
from tmpud.viewer.control_chart import CELLS, _excess


def elements(svg: str) -> list[str]:
    return [element.tag.rpartition("}")[2] for element in ET.fromstring(svg).iter()]  # noqa: S314 - our own


class Cells(HTMLParser):
    """Collects the tags and texts of a table."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.texts: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        assert not attrs

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def test_a_network_shows_all_of_its_lanes() -> None:
    svg = PROBLEM.network._repr_svg_()
    assert set(elements(svg)) == {"svg", "title", "path"}
    lanes = [line for line in svg.split("<path ") if 'fill="none"' in line]
    assert sum(line.count("M") for line in lanes) == 2 * len(PROBLEM.network.lanes)


def test_a_plan_shows_the_metres_and_the_safety_term_of_each_action() -> None:
    cells = Cells(REPORT._repr_html_())
    assert cells.tags.count("tr") == len(REPORT.plan) + 1
    metres = [float(text) for text in cells.texts if text.replace(".", "").isdigit()]
    assert sum(metres[::2]) == pytest.approx(REPORT.cost_m, abs=0.1 * len(REPORT.plan))
    assert sum(metres[1::2]) == pytest.approx(REPORT.penalty_m, abs=0.1 * len(REPORT.plan))
    event = next(event for event in decision() if isinstance(event, Planned))
    assert Cells(event._repr_html_()).tags.count("tr") == len(MERGE_NOW) + 1


def test_an_estimate_shows_where_the_share_of_light_cells_is_what_it_says() -> None:
    made = estimate()
    assert made.sets is not None
    assert {"image", "path"} <= set(elements(made._repr_svg_()))
    shares = (_excess(made.sets, 0) <= 0.0).mean(axis=(1, 2))
    assert shares == pytest.approx(made.o[0], abs=2.0 / CELLS)
    assert shares.min() < 0.9


def test_an_estimate_without_vehicles_is_shown_too() -> None:
    alone = replace(estimate(), safe=1.0, worst=None, ids=(), sets=None)
    assert "image" not in elements(alone._repr_svg_())


@pytest.mark.parametrize("name", [*NAMES, "$\\frac{", "日本"])
def test_no_name_is_markup(name: str) -> None:
    network = replace(PROBLEM.network, name=name)
    assert set(elements(network._repr_svg_())) == {"svg", "title", "path"}
    step = REPORT.plan[0]._replace(state=State(name, 0))
    page = replace(REPORT, plan=(step, *REPORT.plan[1:]))._repr_html_()
    assert set(Cells(page).tags) == {"table", "caption", "thead", "tbody", "tr", "th", "td"}


@pytest.mark.parametrize("name", [NAMES[0], NAMES[4], "]]>", "-->", "$\\frac{", "日本", "\ud83d"])
def test_no_vehicle_is_markup(name: str) -> None:
    assert not {"script", "image/svg"} & set(elements(estimate(name)._repr_svg_()))


def test_the_same_thing_gives_the_same_picture() -> None:
    assert estimate()._repr_svg_() == estimate()._repr_svg_()
