"""Trials driven again when somebody asks for their replays: one at a time, in a process of its own, kept in a cache."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import tempfile
import time
import weakref
from collections.abc import Hashable, Iterator
from contextlib import aclosing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmpud.errors import RunFileError, TmpudError
from tmpud.recording import LOG
from tmpud.roads.cache import cache_folder
from tmpud.server import children
from tmpud.server.index import is_file

if TYPE_CHECKING:
    from tmpud.experiments.again import Trial

KEPT = 50  # drives in the cache
PATIENCE = 10.0  # [s] a drive that waits is given up after nobody has asked for it any more
TOLD = "compared.json"
SAID = 0.3  # [s] between two words on how far it is


@dataclass(slots=True)
class Drive:
    """How far a trial is that is driven again."""

    phase: str = "waiting"  # "beginning", "driving", "driven" or "failed"
    share: float = 0.0
    begun: float = 0.0  # monotonic clock, when it left its start
    folder: Path | None = None  # of the run, once it is driven
    differences: list[str] = field(default_factory=list)  # from what was kept of it
    remarks: list[str] = field(default_factory=list)
    failure: str = ""
    asked: float = 0.0  # monotonic clock
    task: asyncio.Task[None] | None = None

    @property
    def there(self) -> bool:
        return self.folder is not None and is_file(self.folder / LOG)

    @property
    def left(self) -> float | None:
        """How long [s] it will take from now on, as far as that can be told."""
        if self.phase != "driving" or self.share < 0.02:
            return None
        return (time.monotonic() - self.begun) * (1 - self.share) / self.share

    def hear(self, told: dict[str, Any]) -> None:
        """Take in what the process says."""
        if "share" in told:
            if self.phase != "driving":
                self.phase, self.begun = "driving", time.monotonic()
            self.share = told["share"]
        elif "failure" in told:
            self.phase, self.failure = "failed", told["failure"]
        else:
            self.folder, self.differences, self.remarks = Path(told["folder"]), told["differences"], told["remarks"]
            self.phase = "driven"


class Redrives:
    """What is being driven again, and what was. To be used within one event loop."""

    def __init__(self) -> None:
        self._drives: dict[Hashable, Drive] = {}
        self._one = asyncio.Lock()
        self._own: Path | None = None

    def of(self, results: Path, key: str, kept: Hashable) -> Drive:
        """Return how far a trial is, which is driven from now on where it was not; ``kept`` tells its results apart."""
        name = (results, key, kept)
        drive = self._drives.get(name)
        if drive is None or (drive.phase == "driven" and not drive.there):
            drive = self._drives[name] = Drive()
            drive.task = asyncio.create_task(self._drive(name, drive, results, key))
        drive.asked = time.monotonic()
        return drive

    async def _drive(self, name: Hashable, drive: Drive, results: Path, key: str) -> None:
        async with self._one:
            if time.monotonic() - drive.asked > PATIENCE:
                del self._drives[name]
                return
            drive.phase = "beginning"
            try:
                async with asyncio.timeout(children.LIMIT):
                    await self._heard(drive, results, key)
            except TimeoutError:
                drive.hear({"failure": f"it took more than {children.LIMIT:.0f} s"})
            except (RunFileError, OSError, ValueError) as error:
                drive.hear({"failure": str(error)})

    async def _heard(self, drive: Drive, results: Path, key: str) -> None:
        async with aclosing(children.heard(__name__, results, json.dumps(key), self._cache())) as lines:
            async for line in lines:
                drive.hear(json.loads(line))

    def _cache(self) -> Path:
        """Return where drives are kept: as long as the server runs, where the user wants no cache."""
        if folder := cache_folder("trials"):
            return folder
        if self._own is None:
            self._own = Path(tempfile.mkdtemp(prefix="tmpud-trials-"))
            weakref.finalize(self, shutil.rmtree, self._own, ignore_errors=True)
        return self._own


def main() -> None:
    """Drive a trial (results folder, key as JSON, cache folder); say as JSON lines how far it is and what came out."""
    results, key, cache = children.begin()
    with os.fdopen(os.dup(1), "w", encoding="utf-8") as out:
        os.dup2(2, 1)  # what the simulator prints is not for the server
        try:
            for told in _told(Path(results), json.loads(key), Path(cache)):
                print(json.dumps(told), file=out, flush=True)
        except (TmpudError, OSError) as error:
            print(json.dumps({"failure": str(error)}), file=out, flush=True)


def _told(results_folder: Path, key: str, cache: Path) -> Iterator[dict[str, Any]]:
    from tmpud.experiments.again import caveats, trial_of
    from tmpud.experiments.running.store import read_results

    results = read_results(results_folder)
    trial = trial_of(results, key)
    folder = cache / trial.stamp
    if not is_file(folder / TOLD):
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache, prefix=".") as draft:
            run = Path(draft) / "run"
            yield from _driven(trial, run)
            shutil.rmtree(folder, ignore_errors=True)
            run.replace(folder)
        _forget_the_oldest(cache)
    os.utime(folder)
    yield {
        "folder": str(folder),
        **json.loads((folder / TOLD).read_text(encoding="utf-8")),
        "remarks": caveats(results),
    }


def _driven(trial: Trial, run: Path) -> Iterator[dict[str, Any]]:
    """Drive into a folder; yield how far it is of the time that the trial took when it was kept."""
    from tmpud.events import Frame
    from tmpud.experiments.again import differences, drive_again

    log, began, said = [], None, 0.0
    expected = float(trial.record.result.get("travel_time") or 300.0)
    for event in drive_again(trial, run):
        if isinstance(event, Frame):
            began = event.time if began is None else began
            if time.monotonic() - said > SAID:
                said = time.monotonic()
                yield {"share": round(min((event.time - began) / expected, 1.0), 3)}
        else:
            log.append(event)
    compared = {"differences": differences(trial, log)}
    (run / TOLD).write_text(json.dumps(compared), encoding="utf-8")


def _forget_the_oldest(cache: Path) -> None:
    """Remove all but the drives that were asked for last, and drafts of drives that were killed."""
    ages = {folder: time.time() - folder.stat().st_mtime for folder in cache.iterdir()}
    drives = sorted((folder for folder in ages if folder.name[0] != "."), key=ages.__getitem__)
    killed = [folder for folder, age in ages.items() if folder.name[0] == "." and age > children.LIMIT]
    for folder in [*drives[KEPT:], *killed]:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
