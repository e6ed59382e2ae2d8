"""Debian's Chromium without a window, opened on a page from disk."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Page, sync_playwright

CHROMIUM = shutil.which("chromium")


@contextmanager
def opened(file: Path, width: int = 1360, height: int = 860) -> Iterator[Page]:
    """Open a replay; fail if it asks for anything but its own file, or says anything on the console."""
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    said: list[str] = []
    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=CHROMIUM)
        page = browser.new_page(viewport={"width": width, "height": height})
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: said.append(request.url) if request.url != file.as_uri() else None)
        page.goto(file.as_uri())
        page.wait_for_selector("html[data-ready=yes]", state="attached", timeout=60_000)
        yield page
        browser.close()
    assert said == []


def clock(page: Page) -> float:
    """Return the seconds of the drive that the page shows."""
    minutes, seconds = page.inner_text("#clock").split(" / ")[0].split(":")
    return 60 * int(minutes) + float(seconds)


def picture(page: Page, scene: str = "#scene") -> bytes:
    """Return a scene as it is drawn now."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page.locator(scene).screenshot()
