"""Trials are driven again one at a time, and end with the server."""

from __future__ import annotations

import asyncio
import json
import os
import time
from pathlib import Path

import pytest

from tests.experiments.made_results import GRID, made_results
from tests.server.asking import served
from tmpud.server import redriving
from tmpud.server.redriving import Drive, Redrives


class Scripted(Redrives):
    """Drives nothing, and notes what it would have driven at the same time."""

    def __init__(self) -> None:
        super().__init__()
        self.under_way = self.most = 0
        self.driven: list[str] = []

    async def _heard(self, drive: Drive, results: Path, key: str) -> None:
        self.under_way += 1
        self.most = max(self.most, self.under_way)
        await asyncio.sleep(0.02)
        self.under_way -= 1
        self.driven.append(key)
        drive.hear({"folder": str(results), "differences": [], "remarks": []})


async def ended(drives: list[Drive]) -> None:
    await asyncio.gather(*(drive.task for drive in drives if drive.task))


def test_one_is_driven_at_a_time_however_many_are_asked_for() -> None:
    async def check() -> Scripted:
        redrives = Scripted()
        await ended([redrives.of(Path("x"), f"{n % 4}", 0) for n in range(12)])
        return redrives

    redrives = asyncio.run(check())
    assert (redrives.most, sorted(redrives.driven)) == (1, ["0", "1", "2", "3"])


def test_who_waits_while_nobody_asks_any_more_is_given_up() -> None:
    async def check() -> list[str]:
        redrives = Scripted()
        drives = [redrives.of(Path("x"), key, 0) for key in ("first", "left", "kept")]
        drives[1].asked -= 3600.0
        await ended(drives)
        assert redrives.of(Path("x"), "left", 0) is not drives[1]
        return redrives.driven

    assert asyncio.run(check()) == ["first", "kept"]


def test_how_long_it_takes_is_told_from_how_far_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [100.0]
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    drive = Drive()
    assert drive.left is None
    drive.hear({"share": 0.0})
    clock[0] += 3.0
    drive.hear({"share": 0.25})
    assert drive.left == pytest.approx(9.0)


def test_only_the_drives_asked_for_last_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(redriving, "KEPT", 3)
    for number, name in enumerate(["old", "older", "new", "newer", "newest", ".draft", ".killed"]):
        (tmp_path / name).mkdir()
        age = {"older": 9e6, "old": 8e6, ".killed": 9e6}.get(name, 10.0 - number)
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    redriving._forget_the_oldest(tmp_path)
    assert {folder.name for folder in tmp_path.iterdir()} == {"new", "newer", "newest", ".draft"}


def children_of(folder: Path) -> list[str]:
    """Return the processes whose command line names a folder."""
    found = []
    for process in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            found += [process.parent.name] * (str(folder).encode() in process.read_bytes())
        except OSError:
            continue
    return found


def test_a_drive_ends_with_its_server_and_leaves_the_results_as_they_were(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMPUD_NO_CACHE", "1")
    folder = made_results(tmp_path / "sweep")
    with served(tmp_path) as server:
        link = server.link(f"{tmp_path.name}/sweep")
        trial = server.ask(f"{link}/points/0").text.partition("../trials/")[2].partition('"')[0]
        assert "is driven again" in server.ask(f"{link}/trials/{trial}").text
        while not children_of(folder):
            server.ask(f"{link}/trials/{trial}/part")
            time.sleep(0.02)
    until = time.monotonic() + 30
    while children_of(folder) and time.monotonic() < until:
        time.sleep(0.05)
    assert children_of(folder) == []
    assert json.loads((folder / "manifest.json").read_text())["tasks"]["count"] == 4 * len(GRID.seeds)
