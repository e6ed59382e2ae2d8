"""The made run that goes straight on (4 s) beside the one that merges and collides (1 s)."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.viewer.browsing import clock, opened, picture
from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import events, header, merging, recorded
from tmpud.viewer.replay import write_comparison


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pair")
    first, second = recorded(folder / "a"), recorded(folder / "b", merging())
    write_comparison(first, second, folder / "pair.html")
    return folder / "pair.html"


@pytest.fixture
def page(file: Path) -> Iterator[Page]:
    with opened(file) as page:
        yield page


def test_both_play_in_step_and_the_shorter_waits_at_its_end(page: Page) -> None:
    before = [picture(page, name) for name in ("#scene", "#scene-2")]
    page.locator(".scrub").fill("500")
    assert all(picture(page, name) != seen for name, seen in zip(("#scene", "#scene-2"), before, strict=True))
    page.keyboard.press(" ")
    page.wait_for_function("() => frameTimes.length > 0")
    page.wait_for_function("() => document.querySelector('#play').textContent === '▶'")
    assert clock(page) == 4.0
    first, second = (page.inner_text(name) for name in CAPTIONS)
    assert ("tmpud" in first, "SUCCESS" in first, "40 m driven" in first, "unsafe: 1" in first) == (True,) * 4
    assert ("no-com" in second, "COLLISION" in second, "5 m driven" in second, "unsafe: 1" in second) == (True,) * 4


CAPTIONS = ("#moment", "#moment-2")


def test_the_panel_tells_how_they_differ_and_where_they_parted(page: Page) -> None:
    assert "SUCCESS\tCOLLISION" in page.inner_text("#results")
    assert "collision (blame: our car)" in page.inner_text("#results")
    parting = page.inner_text("#parting")
    assert "tmpud chose to go straight on, no-com chose to merge left" in parting
    assert "Safe of merge left\t0.50, counts as" in parting
    assert page.locator("#notices").count() == 0
    page.click("text=Why did tmpud change its plan?")
    assert "Plan A was to merge left now" in page.inner_text(".why")
    page.locator(".scrub").fill("3000")
    page.click("text=Go there")
    assert clock(page) == 0.0


def test_what_is_written_at_one_place_stands_one_above_the_other_and_inside(page: Page) -> None:
    page.evaluate(LISTEN)
    page.click("text=Overlaid")
    page.click("text=Town")
    picture(page)
    texts = page.evaluate("Object.entries(written)")
    words = " ".join(text for text, _ in texts)
    assert all(part in words for part in ("tmpud", "no-com (ghost)", "limits Safe"))
    width = page.evaluate("document.querySelector('#scene').clientWidth")
    assert all(x >= 0 and x + length <= width for _, (x, _, length) in texts)
    for number, (_, (x, y, length)) in enumerate(texts):
        for _, (left, top, other) in texts[:number]:
            assert abs(y - top) >= 12 or x + length <= left or left + other <= x


# Keeps where each label of a picture was written, the scale bar's first: x, y and width [px]
LISTEN = """() => {
    const brush = CanvasRenderingContext2D.prototype, write = brush.strokeText;
    window.written = {};
    brush.strokeText = function (text, x, y) {
        if (/^\\d+ m$/.test(text)) window.written = {};
        if (this.font.startsWith("600 12px") && this.canvas.id === "scene")
            window.written[text] = [x, y, this.measureText(text).width];
        return write.call(this, text, x, y);
    };
}"""


def test_overlaid_the_other_car_is_a_ghost_and_each_can_be_the_one_looked_at(page: Page) -> None:
    page.locator(".scrub").fill("900")
    page.click("#layout >> text=Overlaid")
    assert [page.is_visible(name) for name in ("#scene", "#scene-2")] == [True, False]
    assert "no-com (ghost)" in page.inner_text("#moment")
    page.click("#which >> text=no-com")
    assert [page.is_visible(name) for name in ("#scene", "#scene-2")] == [False, True]
    assert "tmpud (ghost)" in page.inner_text("#moment-2")
    assert page.inner_text(".closer #unsafe").count("collision") == 1
    page.click("#layout >> text=Side by side")
    assert [page.is_visible(name) for name in ("#scene", "#scene-2")] == [True, True]
    assert "ghost" not in page.inner_text("#moment-2")


def test_the_ghost_is_drawn(page: Page) -> None:
    page.locator(".scrub").fill("900")
    page.keyboard.press("f")
    page.click("#layout >> text=Overlaid")
    assert page.evaluate(GHOSTLY) > 100


# How many points of the scene have the ghost's colour, #7a2f9d
GHOSTLY = """() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => {
    const canvas = document.querySelector("#scene"), context = canvas.getContext("2d");
    const points = context.getImageData(0, 0, canvas.width, canvas.height).data;
    let found = 0;
    for (let i = 0; i < points.length; i += 4)
        found += points[i] === 0x7a && points[i + 1] === 0x2f && points[i + 2] === 0x9d;
    done(found);
})))"""


def test_the_views_move_together_until_they_are_parted(page: Page) -> None:
    page.keyboard.press("w")
    before = picture(page, "#scene-2")
    drag(page)
    moved = picture(page, "#scene-2")
    assert moved != before
    page.click("text=move both views together")
    drag(page)
    assert picture(page, "#scene-2") == moved


def drag(page: Page) -> None:
    page.mouse.move(200, 300)
    page.mouse.down()
    page.mouse.move(250, 350)
    page.mouse.up()
    page.mouse.move(200, 700)  # off the scene, where no lane is named


def test_what_else_differs_is_said_and_what_is_missing_of_either(tmp_path: Path) -> None:
    first = recorded(tmp_path / "a")
    second = recorded(tmp_path / "b", merging(seed=2)[:-1])
    write_comparison(first, second, tmp_path / "pair.html")
    with opened(tmp_path / "pair.html") as page:
        assert "seed: 1 and 2, so the traffic is not the same" in page.inner_text("#notices")
        page.click("#which >> text=no-com")
        assert "no end" in page.inner_text("#missing")
        assert "no end is recorded" in page.inner_text("#results")


def test_on_a_telephone_they_are_overlaid_and_nothing_is_cut_off(file: Path) -> None:
    with opened(file, width=390, height=844) as page:
        assert page.get_attribute("#layout button:nth-child(2)", "aria-pressed") == "true"
        page.click("text=Why did tmpud change its plan?")
        page.click("#layout >> text=Side by side")
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        assert [page.is_visible(name) for name in ("#scene", "#scene-2")] == [True, True]


def test_hostile_names_and_runs_of_which_little_is_left_do_nothing(tmp_path: Path) -> None:
    names = [name.encode(errors="replace").decode() for name in NAMES[:4]]
    told = dict(zip(("algorithm", "preset", "seed", "goal"), names, strict=True))
    first, second = recorded(tmp_path / "a", [header()]), recorded(tmp_path / "b", events(**told))
    write_comparison(first, second, tmp_path / "pair.html")
    with opened(tmp_path / "pair.html") as page:
        assert names[0] in page.inner_text("h1")
        page.click("#layout >> text=Overlaid")
        page.keyboard.press(" ")
        page.wait_for_function("() => frameTimes.length > 0")
        assert page.evaluate("window.struck") is None
