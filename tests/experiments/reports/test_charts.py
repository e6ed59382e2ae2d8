import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from tests.experiments.planted import planted, row
from tmpud.experiments.reports.charts import Panel, batch_panels, draw, interval_panels
from tmpud.experiments.reports.table import anchor
from tmpud.experiments.statistics.cells import cells
from tmpud.experiments.statistics.pairing import pair
from tmpud.experiments.statistics.paper_numbers import TABLE1
from tmpud.experiments.statistics.rows import TrialRow

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def elements(svg: str) -> list[str]:
    """Return the names of a well-formed document's elements."""
    return [str(element.tag).rpartition("}")[2] for element in ET.fromstring(svg).iter()]  # noqa: S314 - our own


def panels_of(rows: list[TrialRow]) -> tuple[Panel, ...]:
    rng = np.random.default_rng(0)
    return interval_panels(cell for paired in pair(rows) for cell in cells(paired, rows, rng, resamples=200))


def test_a_point_lies_within_its_interval_and_is_where_the_cell_is() -> None:
    (panel,) = panels_of(planted(200, seed=1))
    assert panel.title == "normal"
    for point in panel.points:
        assert point.distance[0] <= point.distance[1] <= point.distance[2]
        assert point.unsafe[0] <= point.unsafe[1] <= point.unsafe[2]


def test_bars_over_batches_are_their_standard_deviation() -> None:
    rows = [
        row("tmpud", trial, batch=trial // 10, distance=400.0 + trial // 10, unsafe=trial < 10 and trial % 2 == 0)
        for trial in range(20)
    ]
    (panel,) = batch_panels(pair(rows))
    (point,) = panel.points
    deviation = 0.5 * 2**0.5  # of 400 and 401
    assert point.distance == pytest.approx((400.5 - deviation, 400.5, 400.5 + deviation))
    assert point.unsafe == pytest.approx((250 - 500 * deviation, 250, 250 + 500 * deviation))  # 500 and 0 per 1,000


def test_one_batch_has_no_bar_and_an_algorithm_that_never_arrived_no_point() -> None:
    (panel,) = batch_panels(pair([row("tmpud", 0), row("no-com", 0, status="COLLISION")]))
    assert [point.unsafe for point in panel.points] == [(0.0, 0.0, 0.0)] * 2
    assert np.isnan([point.distance[1] for point in panel.points]).all()
    assert draw([panel], TABLE1, "x", "").png.startswith(SIGNATURE)


def test_a_picture_is_a_png_and_an_svg_and_the_same_every_time() -> None:
    panels = panels_of(planted(50, seed=2))
    first, second = draw(panels, TABLE1, "table1", "caption"), draw(panels, TABLE1, "table1", "caption")
    assert first == second
    assert first.png.startswith(SIGNATURE)
    assert elements(first.svg)[0] == "svg"


def test_the_papers_points_are_drawn_where_it_has_any() -> None:
    panels = panels_of(planted(50, seed=3))
    grey = "#9aa0a8"
    assert grey in draw(panels, TABLE1, "", "").svg
    assert grey not in draw(panels, {}, "", "").svg


def test_names_are_drawn_as_they_are_whatever_they_hold() -> None:
    hostile = ("<script>alert(1)</script>", "$\\frac{", "--><b>", "half a pair \ud800", "very " * 99)
    rows = [row(name, trial, condition=hostile[1]) for name in hostile for trial in range(3)]
    assert not {"script", "b"} & set(elements(draw(panels_of(rows), {}, "x", "").svg))


def test_a_legend_that_is_too_wide_takes_another_row_from_the_panel() -> None:
    names = ("tmpud", *(f"an algorithm with a long name, {number}" for number in range(6)))

    def height(algorithms: tuple[str, ...]) -> float:
        rows = [row(name, trial) for name in algorithms for trial in range(3)]
        svg = draw(panels_of(rows), {}, "x", "").svg
        (panel,) = re.findall(r'id="patch_2">\s*<path d="([^"]*)"', svg)  # the panel's background
        ys = [float(y) for y in re.findall(r"[ML] [\d.]+ ([\d.]+)", panel)]
        return max(ys) - min(ys)

    assert height(names) < height(names[:1])


def test_each_point_is_a_link_that_says_what_it_stands_for() -> None:
    panels = panels_of(planted(50, seed=2))
    svg = draw(panels, TABLE1, "table1", "caption").svg
    links = re.findall(r'<a xlink:href="#(cell-\w+)"><title>([^<]+)</title>', svg)
    assert links == [
        (anchor("normal", point.algorithm), point.words) for point in panels[0].points if point.distance[1] > 0
    ]
    assert len(links) == 5
    assert "_blank" not in svg
