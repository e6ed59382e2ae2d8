"""Frame times of the replay's page in Chromium without a window, drawn by software.

    python -m benchmarks frames --vehicles 200 --frames 200 --rounds 4

One mission is driven and its replay opened (``--run`` takes a run that is there). Then pages take turns, each for
some frames: an empty one, which shows what the browser itself can do; the replay playing, close to the car and
following it; the replay playing with the whole town in view. A frame time is the time between two calls of
``requestAnimationFrame``, measured in the page. A second table has the time that the page's own script spent on
drawing each frame, which is less than the frame: the browser draws what it was told afterwards. The browser shows at
most 60 pictures a second, so that a frame takes 16.7 ms or a multiple.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.harness import Result, SkipError, need, progress
from tmpud.events import Frame
from tmpud.recording import read_run
from tmpud.viewer.replay import write_replay

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

EMPTY, FOLLOWED, TOWN = "an empty page", "following the car", "the whole town"
KEYS = {FOLLOWED: "f", TOWN: "w"}
WIDTH, HEIGHT = 1360, 860  # [px]
BY_SOFTWARE = ("--disable-gpu",)
MEASURE = """frames => new Promise(done => {
    const times = [];
    let before = null;
    const tick = now => {
        if (before !== null) times.push(now - before);
        before = now;
        if (times.length < frames) requestAnimationFrame(tick); else done(times);
    };
    requestAnimationFrame(tick);
})"""


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--run", type=Path, help="a run folder; default: a mission is driven")
    parser.add_argument("--vehicles", type=int, default=200, help="of the mission that is driven")
    parser.add_argument("--frames", type=int, default=150, help="of a turn")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--seed", type=int, default=16)


def measure(asked: argparse.Namespace) -> list[Result]:
    need("playwright")
    browser = shutil.which("chromium")
    if browser is None:
        raise SkipError("Chromium is not installed")
    with tempfile.TemporaryDirectory() as folder, _opened(browser) as opened:
        run = asked.run or _driven(asked, Path(folder) / "run")
        write_replay(run, Path(folder) / "replay.html")
        frames, drawn = _turns(opened, Path(folder) / "replay.html", asked)
        facts = {"browser": opened.version, "vehicles": _vehicles(run)}
    title = f"a frame of the replay, {facts['vehicles']} vehicles, {WIDTH} x {HEIGHT} pixels"
    return [
        Result(title, EMPTY, frames, clock="wall clock", facts=facts),
        Result("drawing a frame", FOLLOWED, drawn, clock="wall clock, the page's script", facts=facts),
    ]


def _driven(asked: argparse.Namespace, run: Path) -> Path:
    """Drive the paper's mission into a run folder."""
    progress(f"one mission among {asked.vehicles} vehicles, seed {asked.seed}")
    mission = ["--from", "park1e_0", "--to", "high4n", "--traffic", str(asked.vehicles), "--seed", str(asked.seed)]
    command = [str(Path(sys.executable).with_name("tmpud")), "drive", *mission, "--json", "--out", str(run)]
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL)  # it need not arrive to be seen
    return run


@contextmanager
def _opened(chromium: str) -> Iterator[Browser]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=chromium, args=list(BY_SOFTWARE))
        yield browser
        browser.close()


Times = dict[str, list[float]]


def _turns(browser: Browser, file: Path, asked: argparse.Namespace) -> tuple[Times, Times]:
    """Return frame times [s], and the drawing's part of them."""
    frames: Times = {EMPTY: [], **{name: [] for name in KEYS}}
    drawn: Times = {name: [] for name in KEYS}
    empty, page = (browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}) for _ in range(2))
    page.goto(file.as_uri())
    page.wait_for_selector("html[data-ready=yes]", state="attached", timeout=600_000)
    for number in range(asked.rounds):
        progress(f"round {number + 1} of {asked.rounds}")
        empty.bring_to_front()
        frames[EMPTY] += _seconds(empty.evaluate(MEASURE, asked.frames))
        page.bring_to_front()
        for name in KEYS:
            shown, told = _played(page, name, asked.frames)
            frames[name] += shown
            drawn[name] += told
    return frames, drawn


def _played(page: Page, name: str, frames: int) -> tuple[list[float], list[float]]:
    """Go on with the replay for some frames; return the frame times and the drawing times [s]."""
    page.keyboard.press(KEYS[name])
    page.keyboard.press(" ")
    page.evaluate("() => { window.drawTimes.length = 0; }")
    times = _seconds(page.evaluate(MEASURE, frames))
    drawn = _seconds(page.evaluate("frames => window.drawTimes.slice(0, frames)", frames))
    page.keyboard.press(" ")
    if len(drawn) < frames:
        raise SkipError(f"the run ends before {frames} frames of each turn were played; ask for fewer")
    return times, drawn


def _seconds(milliseconds: list[float]) -> list[float]:
    return [value / 1000 for value in milliseconds]


def _vehicles(run: Path) -> int:
    """Return how many vehicles besides the ego a run shows at first."""
    return next(len(event.ids) for event in read_run(run) if isinstance(event, Frame))
