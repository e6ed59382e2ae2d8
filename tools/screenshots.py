"""Take the pictures of the demo's replay that the docs show, with Debian's Chromium.

python -m tools.screenshots [RUN]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from tests.viewer.browsing import opened
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
    print(f"wrote replay.png, replay-plans.png and replay-safety.png to {IMAGES}")


if __name__ == "__main__":
    main()
