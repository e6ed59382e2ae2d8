"""The demo is driven once for all of this module's tests, however many processes run them."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.viewer.browsing import clock, opened
from tmpud.cli.driving import DEMO_SEED, DEMO_TRAFFIC
from tmpud.events import Estimated, Finished, Planned, Refused
from tmpud.recording import read_run, record
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.runner import Mission, drive
from tmpud.viewer.replay import write_comparison, write_replay

MEGABYTES = 5  # a page may have
WORDS = "words.txt"


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder that holds the demo's run folder and what it printed."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if base.name.startswith("popen-") else base) / "the-demo"
    try:
        folder.mkdir()
    except FileExistsError:  # another process drives it
        for _ in range(3000):
            if (folder / WORDS).exists():
                return folder
            time.sleep(0.1)
        pytest.fail("the demo did not end")
    command = [str(Path(sys.executable).parent / "tmpud"), "demo", "--out", str(folder / "demo")]
    words = subprocess.run(command, check=True, capture_output=True, text=True, timeout=300).stdout
    (folder / "words").write_text(words)
    (folder / "words").rename(folder / WORDS)
    return folder


def test_the_demo_changes_its_plan_for_a_low_safe_and_arrives(demo: Path) -> None:
    folder, words = demo / "demo", (demo / WORDS).read_text()
    events = list(read_run(folder))
    plan_a, plan_b, *_ = (event for event in events if isinstance(event, Planned))
    refused = next(event for event in events if isinstance(event, Refused))
    assert refused.step == plan_a.plan[0]
    assert refused.step not in plan_b.plan
    assert refused.safe == next(event for event in events if isinstance(event, Estimated)).safe < 0.5
    assert next(event for event in events if isinstance(event, Finished)).status == "SUCCESS"
    assert "plan A" in words
    assert "plan B" in words
    assert {file.name for file in folder.iterdir()} == {"run.jsonl.gz", "timing.jsonl", "map.png"}
    assert (folder / "map.png").read_bytes().startswith(b"\x89PNG")


def test_the_demos_replay_tells_from_the_page_alone_why_the_plan_changed(demo: Path, tmp_path: Path) -> None:
    file = tmp_path / "replay.html"
    assert write_replay(demo / "demo", file) == []
    assert file.stat().st_size < MEGABYTES * 1e6
    refused = [event for event in read_run(demo / "demo") if isinstance(event, Refused)]
    with opened(file) as page:
        assert page.locator(".change .headline").all_inner_texts() == [
            f"merging left was not safe enough: Safe = {event.safe:.2f}" for event in refused
        ]
        page.click(".changes li:last-child .change")
        why = page.inner_text(".changes li:last-child .why")
        assert "It would have kept plan" in why
        assert f"instead of {refused[-1].safe:.2f}" in why
        page.click(".changes li:last-child .to-safety")
        assert page.locator("#safety .maps .cell").count() > 10
        assert f"{refused[-1].safe:.2f} (sets Safe)" in page.inner_text("#vehicle")
        page.locator(".scrub").fill("100000")
        assert clock(page) == 100.0
        before = clock(page)
        page.keyboard.press(" ")
        page.wait_for_function("() => frameTimes.length > 20")
        page.keyboard.press(" ")
        assert clock(page) > before


def test_beside_no_com_the_page_shows_what_the_estimate_was_good_for(demo: Path, tmp_path: Path) -> None:
    start, goal, _ = PAPER_MISSIONS["millbrook"]
    mission = Mission(map="millbrook", start=start, goal=goal, algorithm="no-com", seed=DEMO_SEED, traffic=DEMO_TRAFFIC)
    *_, end = record(drive(mission), tmp_path / "no-com")
    assert isinstance(end, Finished)
    assert write_comparison(demo / "demo", tmp_path / "no-com", tmp_path / "compare.html") == []
    assert (tmp_path / "compare.html").stat().st_size < MEGABYTES * 1e6
    refused = next(event for event in read_run(demo / "demo") if isinstance(event, Refused))
    with opened(tmp_path / "compare.html") as page:
        assert f"SUCCESS\t{end.status}" in page.inner_text("#results")
        parting = page.inner_text("#parting")
        assert "no-com chose to merge left" in parting
        assert f"Safe of merge left\t{refused.safe:.2f}, counts as" in parting
        page.keyboard.press("End")
        assert end.status in page.inner_text("#moment-2")
