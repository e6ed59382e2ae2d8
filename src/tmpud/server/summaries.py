"""What the list says of each run and experiment."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from tmpud.errors import TmpudError
from tmpud.events import Finished, Header
from tmpud.experiments.running import manifest, store
from tmpud.experiments.running.tasks import DONE
from tmpud.recording import LOG
from tmpud.server.index import RUN, Entry, is_file
from tmpud.server.logs import Log

LIVE = 60.0  # [s] a log without an end counts as being written after it last grew
REPORT = "report.html"
ENDED, WRITTEN, BROKEN = "ended", "live", "broken"  # how it is with a run or an experiment


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """What is said of an entry; every text may be hostile."""

    state: str  # ENDED, WRITTEN or BROKEN
    status: str
    about: str = ""
    details: tuple[tuple[str, str], ...] = ()
    missing: tuple[str, ...] = ()
    share: float | None = None  # of an experiment's tasks that have ended
    shown: bool = True  # whether there is a page of it
    changed: str = ""  # local time
    version: str = ""  # another one when there is more to see
    town: str = ""  # digest of a run's map, "" where it is unknown
    traffic: str = ""  # how many vehicles, and their seed


class Summaries:
    """Keeps what was read, so that only what is new is read again."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._logs: dict[str, Log] = {}
        self._experiments: dict[str, tuple[tuple[int, ...], Summary]] = {}

    def of(self, entry: Entry, until: float) -> Summary:
        """Return what is known of an entry when the monotonic clock is at ``until``."""
        with self._lock:
            try:
                return self._run(entry, until) if entry.kind == RUN else self._experiment(entry)
            except (TmpudError, OSError) as error:
                return _unread(str(error))
            except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
                return _unread(f"it is not what tmpud writes ({error!r})")

    def _run(self, entry: Entry, until: float) -> Summary:
        log = self._logs.setdefault(entry.id, Log(entry.folder / LOG))
        found = (entry.folder / LOG).stat()
        if log.read_on(until):
            summary = _run(log, time.time() - found.st_mtime < LIVE)
        else:
            summary = Summary(state=WRITTEN, status="being read")
        town, traffic = _where(log.first)
        changed, version = _clock(found.st_mtime), str(found.st_size)
        return replace(summary, changed=changed, version=version, town=town, traffic=traffic)

    def _experiment(self, entry: Entry) -> Summary:
        stamp = tuple(_stamps(entry.folder))
        known = self._experiments.get(entry.id)
        if known is None or known[0] != stamp:
            known = self._experiments[entry.id] = stamp, _experiment(entry.folder)
        return known[1]


def _run(log: Log, fresh: bool) -> Summary:
    """Return what a log tells that grew a moment ago, or did not."""
    header, end = log.first, log.last
    missing = [f"damaged in the log: {log.damage}"] if log.damage else []
    live = fresh and not log.damage
    if not isinstance(header, Header):
        begun = live and not log.lines
        why = "no header can be read, so it cannot be told what was run"
        status = "just begun" if begun else "cannot be read"
        return Summary(state=WRITTEN if begun else BROKEN, status=status, missing=(*missing, why), shown=False)
    about, lines = _mission(header), ("lines of the log", f"{log.lines:,}")
    if isinstance(end, Finished):
        far = f"{end.distance:,.0f} m in {end.travel_time:,.1f} s, replans: {end.replans}"
        details = ((end.status, f"{far}{'; ' if end.message else ''}{end.message}"), lines)
        return Summary(state=ENDED, status=end.status, about=about, details=details, missing=tuple(missing))
    seen = (("simulated time", f"{end.time:,.1f} s"), lines) if end else (lines,)
    if not live:
        missing.append("the run has no end: it was broken off, or stands still")
    state, status = (WRITTEN, "being written") if live else (BROKEN, "no end")
    return Summary(state=state, status=status, about=about, details=seen, missing=tuple(missing))


def _where(header: object) -> tuple[str, str]:
    """Return which map a run is on, and what its traffic is."""
    if not isinstance(header, Header) or not isinstance(header.map, dict):
        return "", ""
    return str(header.map.get("digest") or ""), f"{header.mission.get('traffic')} {header.mission.get('seed')}"


def _mission(header: Header) -> str:
    mission = header.mission
    places = [mission.get("start"), *(mission.get("via") or ()), mission.get("goal")]
    beta = f"({mission.get('beta')})" if mission.get("algorithm") == "threshold" else ""
    driver = f"{mission.get('algorithm')}{beta}, {mission.get('traffic')} vehicles, seed {mission.get('seed')}"
    return f"{mission.get('map')}: {' → '.join(map(str, places))}; {driver}"


def _experiment(folder: Path) -> Summary:
    results = store.read_results(folder)
    total = int(results.manifest["tasks"]["count"])
    counts = Counter(record.status for record in results.records)
    ended, faults = len(results.records), {name: n for name, n in sorted(counts.items()) if name != DONE}
    missing = [f"damaged and left out: {damage}" for damage in results.damages[:3]]
    missing += [f"{len(results.damages) - 3} more lines are damaged"] * (len(results.damages) > 3)
    missing += [f"{n} task{'s' * (n > 1)} ended in a tool fault: {name}" for name, n in faults.items()]
    live = not results.complete and _in_use(folder / store.LOCK)
    if not results.complete and not live:
        missing.append(f"{total - ended:,} tasks are not done; the same command goes on from there")
    return Summary(
        state=ENDED if results.complete else WRITTEN if live else BROKEN,
        status=f"{ended:,} of {total:,}",
        about=str(results.manifest["command"]) or str(results.manifest["experiment"]),
        details=tuple((name, str(value)) for name, value in store.provenance(results).items()),
        missing=tuple(missing),
        share=min(ended / total, 1.0) if total > 0 else 1.0,
        shown=is_file(folder / REPORT),
        changed=_clock((folder / store.RESULTS).stat().st_mtime),
        version=f"{ended} {(folder / REPORT).stat().st_mtime_ns if is_file(folder / REPORT) else ''}",
    )


def _stamps(folder: Path) -> Iterator[int]:
    """Yield what changes whenever an experiment's summary does."""
    for name in (store.RESULTS, manifest.MANIFEST, REPORT):
        if is_file(folder / name):
            found = (folder / name).stat()
            yield from (found.st_size, found.st_mtime_ns)
        yield -1
    yield _in_use(folder / store.LOCK)


def _in_use(lock: Path) -> bool:
    """Whether the process that last took the folder is there; the lock itself is not touched."""
    try:
        return is_file(lock) and Path(f"/proc/{int(lock.read_text(encoding='utf-8')[:20])}").exists()
    except (OSError, ValueError):
        return False


def _clock(seconds: float) -> str:
    return datetime.fromtimestamp(seconds).astimezone().isoformat(" ", "seconds")[:19]


def _unread(why: str) -> Summary:
    return Summary(state=BROKEN, status="cannot be read", missing=(why,), shown=False)
