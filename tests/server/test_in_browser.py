"""The pages in a browser: names do nothing, the list follows what is written, the replay plays inside its page."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import FrameLocator, Page, sync_playwright

from tests.experiments.made_results import GRID, made_results
from tests.server.asking import Served, served
from tests.server.test_pages import TASKS, campaign, done, hostile_folder
from tests.viewer.browsing import CHROMIUM
from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import recorded
from tmpud.experiments.kinds import findings
from tmpud.experiments.reports.document import write_report
from tmpud.experiments.reports.table import anchor
from tmpud.experiments.running.store import read_results
from tmpud.recording import LOG


@contextmanager
def browsing(server: Served, expected: str = "nothing at all") -> Iterator[Page]:
    """Open the list; fail if a page asks anybody else or says anything unexpected on the console."""
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    said: list[str] = []
    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=CHROMIUM)
        page = browser.new_page()
        page.set_default_timeout(120_000)
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("dialog", lambda dialog: said.append(dialog.message))
        page.on("request", lambda asked: said.append(asked.url) if not asked.url.startswith(server.url) else None)
        page.goto(server.url)
        yield page
        browser.close()
    assert [line for line in said if expected not in line] == []


def played(page: Page) -> FrameLocator:
    """Play the replay inside a page."""
    replay = page.frame_locator("#frame")
    replay.locator("#play").click()
    replay.locator("#clock").wait_for()
    return replay


def test_hostile_names_do_nothing(tmp_path: Path) -> None:
    root = hostile_folder(tmp_path / "root")
    refusal = "/report' because the document's frame is sandboxed and the 'allow-scripts' permission is not set"
    with served(root) as server, browsing(server, refusal) as page:
        links = page.locator("tbody a").evaluate_all("links => links.map(link => link.href)")
        assert len(links) == len(NAMES) + 1
        (root / "sweep" / "report.html").write_text("<script>window.top.struck = window.struck = 1</script>")
        for link in [*links, f"{server.url}{server.link('root/sweep')}"]:
            assert page.evaluate("window.struck") is None
            page.route("**/replay", lambda route: route.fulfill(body=""))
            page.goto(link)
        assert page.evaluate("window.struck") is None


def test_the_list_follows_a_campaign_and_a_run(tmp_path: Path) -> None:
    data = (recorded(tmp_path / "made") / LOG).read_bytes()
    root = tmp_path / "root"
    (root / "run").mkdir(parents=True)
    (root / "run" / LOG).write_bytes(data[:1400])
    with campaign(root / "sweep") as store, served(root) as server, browsing(server) as page:
        page.wait_for_selector("text=0 of 4")
        page.wait_for_selector("text=being written")
        store.append([done(task) for task in TASKS[:3]])
        (root / "run" / LOG).write_bytes(data)
        page.wait_for_selector("text=3 of 4")
        page.wait_for_selector("text=SUCCESS")


def test_a_narrow_window_shows_all_that_the_list_says(tmp_path: Path) -> None:
    recorded(tmp_path / "root" / "run")
    with served(tmp_path / "root") as server, browsing(server) as page:
        page.set_viewport_size({"width": 390, "height": 844})
        told = page.locator("tbody td")
        assert told.count() == 4
        assert told.evaluate_all("cells => cells.map(cell => cell.getBoundingClientRect().right <= 390)") == [True] * 4
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_a_replay_plays_inside_its_page_and_what_came_since_can_be_had(tmp_path: Path) -> None:
    data = (recorded(tmp_path / "made") / LOG).read_bytes()
    (tmp_path / "root" / "run").mkdir(parents=True)
    log = tmp_path / "root" / "run" / LOG
    log.write_bytes(data[: len(data) * 3 // 4])
    with served(tmp_path / "root") as server, browsing(server) as page:
        page.click("text=root/run")
        replay = page.frame_locator("#frame")
        replay.locator("#missing").wait_for()
        assert "no end" in replay.locator("#missing").inner_text()
        log.write_bytes(data)
        page.click("text=Show what came since")
        replay.locator("#missing").wait_for(state="detached")
        played(page)
        assert page.locator("#newer").is_hidden()


def test_a_run_and_another_play_in_step_inside_one_page(tmp_path: Path) -> None:
    recorded(tmp_path / "root" / "one")
    recorded(tmp_path / "root" / "two")
    with served(tmp_path / "root") as server, browsing(server) as page:
        page.click("text=root/one")
        page.click("text=Beside another run")
        page.click("a:has-text('root/two')")
        replay = played(page)
        assert replay.locator("canvas").count() >= 2


def test_a_click_leads_from_a_point_to_its_trials_and_on_to_the_replay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    made_results(tmp_path / "root" / "sweep", replace(GRID, algorithms=("tmpud",), seeds=(1,)))
    with served(tmp_path / "root") as server, browsing(server) as page:
        page.click("text=root/sweep")
        page.locator("#points svg").nth(1).locator("a .mark").click()
        page.wait_for_selector("h1:has-text('normal')")
        page.click("text=0: its replay")
        page.wait_for_selector("text=not the same")
        played(page)
        page.go_back()
        page.go_back()
        page.locator("#points svg a").first.focus()
        page.keyboard.press("Enter")
        page.wait_for_selector("h1:has-text('heavy')")


def test_a_point_of_a_report_leads_to_its_row(tmp_path: Path) -> None:
    found = findings(read_results(made_results(tmp_path / "sweep")))
    write_report(tmp_path / "sweep", found.report())
    shade = "(rows) => rows.map(row => getComputedStyle(row.cells[1]).backgroundColor)"
    with served(tmp_path) as server, browsing(server, "report.html") as page:
        page.goto((tmp_path / "sweep" / "report.html").as_uri())
        rows, links = page.locator("tr[id]"), page.locator("figure a")
        plain = rows.evaluate_all(shade)
        for number, cell in enumerate(found.analysis.cells):
            place = f"#{anchor(cell.condition, cell.algorithm)}"
            (link,) = [link for link in links.all() if link.get_attribute("xlink:href") == place]
            assert f"{cell.per_1000.value:.1f} unsafe" in str(link.locator("title").text_content())
            for act in (link.focus, lambda link=link: link.press("Enter")):
                act()
                changed = [was != now for was, now in zip(plain, rows.evaluate_all(shade), strict=True)]
                assert changed[number]
            assert page.url.endswith(place)
            assert sum(changed) == 1
