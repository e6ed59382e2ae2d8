"""Take the pictures of the demo's replay and of a notebook that the docs show, with Debian's Chromium.

python -m tools.screenshots [RUN]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from tests.viewer.browsing import CHROMIUM, opened
from tests.viewer.made_results import PROBLEM, REPORT, estimate
from tmpud.viewer.replay import write_replay

ROOT = Path(__file__).resolve().parents[1]
IMAGES = ROOT / "docs" / "images"


def main() -> None:
    """Open the replay of a run (runs/demo unless another is named) and take three pictures."""
    run = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "runs" / "demo"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "replay.html"
        write_replay(run, file)
        with opened(file) as page:
            page.click(".changes li:last-child .change")
            page.wait_for_timeout(500)
            page.screenshot(path=IMAGES / "replay.png")
            page.keyboard.press("w")
            page.click("[aria-label='Light or dark']")
            page.locator(".changes li:last-child .why table").scroll_into_view_if_needed()
            page.wait_for_timeout(500)
            page.screenshot(path=IMAGES / "replay-plans.png")
            page.click("[aria-label='Light or dark']")
            page.locator("#safety").screenshot(path=IMAGES / "replay-safety.png")
    _notebook()
    print(f"wrote notebook.png, replay.png, replay-plans.png and replay-safety.png to {IMAGES}")


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
