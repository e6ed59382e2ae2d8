"""Trials of the command line, each a process of its own, two at a time."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from tmpud.errors import RunFileError
from tmpud.events import Estimated, Executed, Judged
from tmpud.judging.rules import RECORDED, UNSAFE
from tmpud.recording import read_run

AT_ONCE = 2
PATIENCE = 1200.0  # [s] wall-clock for one trial
UNSAFE_MERGE = 0.5  # a merge below this Safe, or one that nobody estimated, was forced
TRIED = "TRACEBACK", "TOOK TOO LONG", "NO RESULT"  # what a trial ends in where the tool itself fails

T = TypeVar("T")
R = TypeVar("R")
_running: set[subprocess.Popen[str]] = set()
_lock = threading.Lock()
_stopping = threading.Event()


@dataclass(frozen=True, slots=True)
class Trial:
    """How one mission ended."""

    status: str  # as the run says, or one of TRIED
    summary: Mapping[str, Any]
    violations: tuple[str, ...]  # kinds of broken rules of the road
    forced_merges: int
    message: str  # the last line on stderr where there is no result
    folder: Path


def drive(folder: Path, arguments: Sequence[str], environment: Mapping[str, str] | None = None) -> Trial:
    """Run ``tmpud drive`` with some arguments and read what it left."""
    command = [str(Path(sys.executable).parent / "tmpud"), "drive", *arguments, "--json", "--out", str(folder)]
    code, out, err = _run(command, {**os.environ, **(environment or {})})
    summary: dict[str, Any] = {}
    with contextlib.suppress(ValueError):
        summary = json.loads(out)
    if "Traceback" in err:
        status = "TRACEBACK"
    elif code is None:
        status = "TOOK TOO LONG"
    else:
        status = str(summary.get("status", "NO RESULT"))
    last = (err.strip().splitlines() or [f"exit code {code}"])[-1]
    violations, forced = _look_into(folder)
    return Trial(status, summary, violations, forced, last[:300] if status in TRIED else "", folder)


def each(work: Callable[[T], R], items: Sequence[T]) -> Iterator[tuple[T, R]]:
    """Do some work on items, AT_ONCE at a time; yield them as they are done. An interrupt ends what runs."""
    pool = ThreadPoolExecutor(AT_ONCE)
    waiting = {pool.submit(work, item): item for item in items}
    try:
        for future in as_completed(waiting):
            yield waiting[future], future.result()
    finally:
        _stopping.set()
        pool.shutdown(wait=False, cancel_futures=True)
        _end_all()
        pool.shutdown()
        _stopping.clear()


def _run(command: Sequence[str], environment: Mapping[str, str]) -> tuple[int | None, str, str]:
    """Run a command in a process group of its own; a code of None says that it took too long."""
    with _lock:
        if _stopping.is_set():
            return 130, "", "interrupted"
        process = subprocess.Popen(
            command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
        )
        _running.add(process)
    try:
        out, err = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        _end(process)
        out, err = process.communicate()
        return None, out, err
    finally:
        _running.discard(process)
    return process.returncode, out, err


def _end_all() -> None:
    with _lock:
        for process in list(_running):
            _end(process)


def _end(process: subprocess.Popen[str]) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _look_into(folder: Path) -> tuple[tuple[str, ...], int]:
    """Return the kinds of broken rules, and how many merges were driven that were unsafe or not estimated."""
    kinds, forced, safe = [], 0, dict[Any, float]()
    with contextlib.suppress(RunFileError):
        for event in read_run(folder):
            if isinstance(event, Estimated):
                safe[event.step] = event.safe
            elif isinstance(event, Judged) and event.kind not in UNSAFE | RECORDED:
                kinds.append(event.kind)
            elif isinstance(event, Executed) and event.step.action.is_merge:
                forced += not event.estimated or safe.get(event.step, 0.0) < UNSAFE_MERGE
    return tuple(kinds), forced
