from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Page

from tests.viewer.browsing import clock, opened, picture
from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import SHARES, decision, events, frame, header, merging, recorded
from tmpud.events import Estimated, Event
from tmpud.viewer.replay import write_replay

MOVING = "() => frameTimes.length > 0"
# The shaded polygon's area as a share of the whole rectangle's
SHADED = """() => {
    const map = document.querySelector(".map"), box = map.querySelector(".border").getBBox();
    const at = [...map.querySelector(".safe").points], next = i => at[(i + 1) % at.length];
    const doubled = at.reduce((sum, p, i) => sum + p.x * next(i).y - p.y * next(i).x, 0);
    return Math.abs(doubled) / 2 / box.width / box.height;
}"""
# The mean shade of the cells of the whole horizon
MEAN_SHADE = """() => {
    const sum = values => values.reduce((total, value) => total + value, 0);
    const cells = [...document.querySelectorAll(".cell")], widths = cells.map(cell => cell.getBBox().width);
    return sum(cells.map((cell, i) => widths[i] * cell.getAttribute("fill-opacity"))) / sum(widths);
}"""


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("replay")
    write_replay(recorded(folder / "run"), folder / "replay.html")
    return folder / "replay.html"


@pytest.fixture
def page(file: Path) -> Iterator[Page]:
    with opened(file) as page:
        yield page


def test_it_plays_to_the_end_and_tells_how_long_each_picture_took(page: Page) -> None:
    before = picture(page)
    page.keyboard.press(" ")
    page.wait_for_function(MOVING)
    page.wait_for_function("() => document.querySelector('#play').textContent === '▶'")
    assert clock(page) == 4.0
    assert picture(page) != before
    assert "SUCCESS" in page.inner_text("#moment")


def test_keys_step_and_the_strip_scrubs(page: Page) -> None:
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    assert clock(page) == 1.1
    page.locator(".scrub").fill("2500")
    assert clock(page) == 2.5
    page.keyboard.press("Home")
    assert clock(page) == 0.0


def test_a_click_on_a_change_explains_it_and_shows_the_plans_to_choose_from(page: Page) -> None:
    page.click(".flag.replan")
    why = page.inner_text(".why")
    assert "Plan A was to merge left now, on Park Street." in why
    assert "It would have kept plan A if" in why
    assert page.locator(".why tbody tr").count() == 2
    assert page.inner_text(".why tr.chosen").startswith("B")
    before = picture(page)
    page.hover(".why tr.given-up")
    assert picture(page) != before


def test_an_unsafe_moment_opens_a_second_before(page: Page) -> None:
    page.click(".flag.unsafe")
    assert clock(page) == 2.0
    assert "forced stop car2 (blame: our car, rule: merge)" in page.inner_text("#unsafe")


def test_a_plan_that_was_kept_until_a_collision_was_not_driven_to_its_end(tmp_path: Path) -> None:
    write_replay(recorded(tmp_path / "run", merging()), tmp_path / "replay.html")
    with opened(tmp_path / "replay.html") as page:
        assert "the first plan was in force to the last" in page.inner_text("#changes")
        page.click("text=This run")
        assert "traffic" in page.inner_text("#panel")
        assert "beta" not in page.inner_text("#panel")  # which no-com does not look at


def test_the_plan_moves_on_with_the_drive(page: Page) -> None:
    assert page.inner_text("#plan tr.now").split("\t")[1] == "↑ straight on"
    assert page.locator("#plan tr.done").count() == 0
    page.keyboard.press("End")
    assert page.locator("#plan tr.done").count() == 1
    assert "merge left" in page.inner_text("#plan")


def test_the_view_can_be_moved_zoomed_and_brought_back(page: Page) -> None:
    seen = [picture(page)]
    for key in ("f", "+", "w"):
        page.keyboard.press(key)
        seen.append(picture(page))
    page.mouse.move(400, 300)
    page.mouse.down()
    page.mouse.move(500, 350)
    page.mouse.up()
    seen.append(picture(page))
    page.mouse.wheel(0, -400)
    seen.append(picture(page))
    page.click("[aria-label='Light or dark']")
    seen.append(picture(page))
    assert len(set(seen)) == len(seen)


def test_its_colours_follow_the_system_until_they_are_changed(page: Page) -> None:
    ink = "getComputedStyle(document.body).color"
    light = page.evaluate(ink)
    page.emulate_media(color_scheme="dark")
    page.wait_for_function(f"() => {ink} !== '{light}'")
    page.click("[aria-label='Light or dark']")
    assert page.evaluate(ink) == light


def test_the_share_at_a_chosen_instant_beside_a_chosen_vehicle_is_that_of_the_log(page: Page) -> None:
    page.click(".flag.replan")
    page.click(".to-safety")
    assert page.evaluate("document.activeElement.id") == "vehicle"
    assert page.locator("#vehicle option").all_inner_texts() == ["car1: 0.50 (sets Safe)", "car2: 0.87"]
    assert "(0.700 + 0.300) / 2 = 0.500" in page.inner_text("#because")
    assert shown_share(page) == min(SHARES[0])
    for vehicle, shares in enumerate(SHARES):
        page.select_option("#vehicle", str(vehicle))
        assert shown_share(page) == min(shares)
        for instant, share in enumerate(shares):
            page.locator("#instant").fill(str(instant))
            assert shown_share(page) == share
            assert f"{0.25 * instant:.2f} s after" in page.inner_text("#share")


def shown_share(page: Page) -> float:
    return float(page.inner_text("#share b").removeprefix("o = "))


def test_the_shaded_area_is_the_share_and_the_line_cuts_it_off(page: Page) -> None:
    page.click(".flag.replan")
    for instant, share in enumerate(SHARES[0]):
        page.locator("#instant").fill(str(instant))
        assert page.evaluate(SHADED) == pytest.approx(share, abs=0.003)
        assert page.locator(".maps figure:first-child .cut").count() == (share < 1)
    assert page.evaluate(MEAN_SHADE) == pytest.approx(sum(SHARES[0]) / len(SHARES[0]), abs=0.02)


def test_the_keyboard_and_a_click_on_the_curve_choose_the_instant(page: Page) -> None:
    page.click(".flag.replan")
    before, moment = picture(page), clock(page)
    page.focus("#instant")
    page.keyboard.press("End")
    assert page.input_value("#instant") == "4"
    assert picture(page) != before
    page.keyboard.press("ArrowLeft")
    assert (page.input_value("#instant"), clock(page)) == ("3", moment)
    page.locator(".curve").click(position={"x": 45, "y": 20})
    assert page.input_value("#instant") == "0"


def test_the_panel_follows_the_drive_and_goes_from_estimate_to_estimate(tmp_path: Path) -> None:
    refused = next(event for event in events() if isinstance(event, Estimated))
    later = replace(refused, time=12.0, safe=0.9, o=SHARES[::-1], planes=refused.planes[::-1])
    write_replay(recorded(tmp_path / "run", [*events(), later]), tmp_path / "replay.html")
    with opened(tmp_path / "replay.html") as page:
        told = page.locator("#safety .estimate")
        assert told.inner_text() == "0:00.0: merge left, Safe = 0.50"
        page.click("[aria-label='The next estimate']")
        assert (told.inner_text(), clock(page)) == ("0:02.0: merge left, Safe = 0.90", 2.0)
        page.click("[aria-label='The estimate before']")
        assert (told.inner_text(), clock(page)) == ("0:00.0: merge left, Safe = 0.50", 0.0)
        page.keyboard.press("End")
        assert told.inner_text() == "0:02.0: merge left, Safe = 0.90"


def test_another_vehicle_is_marked_in_the_scene(page: Page) -> None:
    page.click(".flag.replan")
    before = picture(page)
    page.select_option("#vehicle", "1")
    assert picture(page) != before
    assert "car2 does not set Safe, car1 does" in page.inner_text("#because")


def test_a_log_of_schema_1_shows_the_curve_and_says_what_it_lacks(tmp_path: Path) -> None:
    log = [replace(event, others=(), planes=()) if isinstance(event, Estimated) else event for event in events()]
    write_replay(recorded(tmp_path / "run", log), tmp_path / "replay.html")
    with opened(tmp_path / "replay.html") as page:
        page.click(".flag.replan")
        assert shown_share(page) == min(SHARES[0])
        assert page.locator(".curve .chosen").count() == 1
        assert page.locator(".map").count() == 0
        assert "schema 1" in page.inner_text(".maps")


@pytest.mark.parametrize("width", [390, 800, 900, 1280])
def test_nothing_is_cut_off_in_a_narrow_window(file: Path, width: int) -> None:
    with opened(file, width=width, height=844) as page:
        page.click(".flag.replan")
        assert page.locator(".why").is_visible()
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert page.evaluate(CUT_OFF) == []
        assert "penalty after" in page.inner_text(".why table") or width < 500


# Texts of cells of which a part lies outside the panel or that are wider than their cell
CUT_OFF = """() => {
    const edge = document.querySelector("#panel").getBoundingClientRect().right;
    const cells = [...document.querySelectorAll("#panel td")];
    return cells.filter(cell => cell.getBoundingClientRect().right > edge || cell.scrollWidth > cell.clientWidth + 1)
        .map(cell => cell.textContent);
}"""


def test_the_mouse_finds_out_what_a_lane_is_called(page: Page) -> None:
    page.keyboard.press("f")
    box = page.locator("#scene").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)  # over our car
    assert page.inner_text(".tip") == "Park Street, lane park1e_0"
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 60)
    assert page.is_hidden(".tip")
    assert page.inner_text("h1") == "Park Street (park1e_0) → Park Street (park2e_1)"


def test_hostile_names_are_shown_and_do_nothing(tmp_path: Path) -> None:
    names = [name.encode(errors="replace").decode() for name in NAMES]
    log = [
        header(start=names[0], goal=names[1]),
        *decision(names[2]),
        *(frame(number, names, {name: name for name in names}) for number in range(5)),
    ]
    write_replay(recorded(tmp_path / "run", log), tmp_path / "replay.html")
    with opened(tmp_path / "replay.html") as page:
        page.click(".flag.replan")
        page.keyboard.press(" ")
        page.wait_for_function(MOVING)
        assert names[0] in page.inner_text("h1")
        assert names[2] in page.inner_text(".why")
        assert page.evaluate("window.struck") is None
        assert page.locator("iframe, img, object, embed, form, base, link, a").count() == 0
        assert "no end" in page.inner_text("#missing")


def test_a_run_of_which_little_is_left_opens_all_the_same(tmp_path: Path) -> None:
    logs: dict[str, list[Event]] = {"header": [header()], "plans": [header(map="atlantis"), *decision()]}
    for name, log in logs.items():
        write_replay(recorded(tmp_path / name, log), tmp_path / f"{name}.html")
        with opened(tmp_path / f"{name}.html") as page:
            page.keyboard.press(" ")
            page.keyboard.press("n")
            page.keyboard.press("f")
            assert "no frames were recorded" in page.inner_text("#missing")
            assert page.locator(".why tbody tr").count() == (2 if name == "plans" else 0)
