"""Take the pictures of the replay and of a notebook that the docs show, with Debian's Chromium.

python -m tools.screenshots

It shows runs/demo, and beside it runs/demo-no-com, the same drive by No-com; what of them is not there is driven first.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

from tests.viewer.browsing import CHROMIUM, opened
from tests.viewer.made_results import PROBLEM, REPORT, estimate
from tmpud.cli.driving import DEMO_SEED, DEMO_TRAFFIC
from tmpud.recording import LOG
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.viewer.replay import write_comparison, write_replay

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"
DEMO, NO_COM = ROOT / "runs" / "demo", ROOT / "runs" / "demo-no-com"
MOMENT = "2500"  # [ms] shown of the pair: a moment after the collision


def main() -> None:
    """Drive what is missing, open the two pages and take their pictures."""
    start, goal, _ = PAPER_MISSIONS["millbrook"]
    mission = ["--from", start, "--to", goal, "--traffic", str(DEMO_TRAFFIC), "--seed", str(DEMO_SEED)]
    _driven(DEMO, ["demo"])
    _driven(NO_COM, ["drive", *mission, "--algorithm", "no-com"])
    with tempfile.TemporaryDirectory() as folder:
        one, two = Path(folder) / "replay.html", Path(folder) / "compare.html"
        write_replay(DEMO, one)
        write_comparison(DEMO, NO_COM, two)
        with opened(one) as page:
            _replay(page)
        with opened(two) as page:
            _comparison(page)
    _notebook()


def _driven(folder: Path, words: list[str]) -> None:
    if not (folder / LOG).exists():
        command = [str(Path(sys.executable).parent / "tmpud"), *words, "--out", str(folder)]
        subprocess.run(command, check=False, cwd=ROOT, stdout=subprocess.DEVNULL)  # a collision is an answer, too


def _replay(page: Page) -> None:
    page.click(".changes li:last-child .change")
    _take(page, "replay")
    page.keyboard.press("w")
    page.click("[aria-label='Light or dark']")
    page.locator(".changes li:last-child .why table").scroll_into_view_if_needed()
    _take(page, "replay-plans")
    page.click("[aria-label='Light or dark']")
    _keep(page.locator("#safety").screenshot(), "replay-safety")


def _comparison(page: Page) -> None:
    page.click("text=Go there")
    page.locator(".scrub").fill(MOMENT)
    _take(page, "compare")
    page.click("#layout >> text=Overlaid")
    page.wait_for_timeout(500)
    _keep(page.locator("#stage").screenshot(), "compare-overlaid")


def _take(page: Page, name: str) -> None:
    page.wait_for_timeout(500)
    _keep(page.screenshot(), name)


def _keep(taken: bytes, name: str) -> None:
    """Write a picture with 256 colours, which makes it a third as large."""
    file = IMAGES / f"{name}.png"
    Image.open(io.BytesIO(taken)).convert("RGB").quantize(256).save(file, optimize=True)
    print(f"wrote {file} ({file.stat().st_size / 1e3:.0f} kB)")


def _notebook() -> None:
    """Take a picture of what a network, a plan and an estimate show of themselves."""
    shown = (PROBLEM.network._repr_svg_(), REPORT._repr_html_(), estimate()._repr_svg_())
    style = "body { font: 14px sans-serif } div { margin: 16px } td { padding: 0 8px } svg { max-height: 420px }"
    page = f"<meta charset=utf-8><style>{style}</style>" + "".join(f"<div>{each}</div>" for each in shown)
    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=CHROMIUM)
        sheet = browser.new_page(viewport={"width": 960, "height": 600})
        sheet.set_content(page)
        sheet.screenshot(path=IMAGES / "notebook.png", full_page=True)
        browser.close()


if __name__ == "__main__":
    main()
