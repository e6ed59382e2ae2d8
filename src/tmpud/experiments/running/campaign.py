"""Campaigns: all tasks of an experiment, done by supervised workers into a folder from which they can be resumed."""

from __future__ import annotations

import signal
import sys
import threading
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from types import FrameType
from typing import Any, NoReturn

from tmpud.errors import RequestError
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.progress import Progress
from tmpud.experiments.running.store import Store
from tmpud.experiments.running.supervisor import Supervisor
from tmpud.experiments.running.tasks import DONE, Record, Task, located
from tmpud.experiments.running.workers import Limits


def complain(message: str) -> None:
    """Say on stderr what a results folder holds that does not count."""
    sys.stderr.write(f"tmpud: {message}\n")


def run_campaign(
    folder: Path,
    experiment: Experiment,
    tasks: Sequence[Task],
    *,
    limits: Limits,
    progress: Progress | None = None,
) -> Iterator[Record]:
    """Yield a record of each task: first those already in the folder, then others as they are done and safe on disk.

    What ended in a tool fault is tried again; its record stays until there is another.
    SIGTERM raises KeyboardInterrupt meanwhile. However it ends, no worker is left, and the same call goes on from
    there. FolderError where the folder is another experiment's, in use, or cannot be written.
    """
    check(tasks)
    with _interruptible() as check_interrupt, Store(folder, experiment, tasks) as store:
        for damage in store.damages:
            complain(damage)
        done = {key: record for key, record in store.records.items() if record.status == DONE}
        if faults := len(store.records) - len(done):
            complain(f"{faults} of {len(tasks)} tasks ended in a tool fault before; trying again")
        missing = [task for task in tasks if task.key not in done]
        if progress:
            progress.skip(len(tasks) - len(missing))
        yield from done.values()
        with closing(Supervisor(missing, limits, store.log).run()) as batches:
            for batch in batches:
                check_interrupt()
                store.append(ended.record for ended in batch)
                store.note(ended.timing for ended in batch)
                for ended in batch:
                    if progress:
                        progress.step()
                    yield ended.record


def check(tasks: Sequence[Task]) -> None:
    """Refuse tasks that share a key or name work that does not exist."""
    for work in {task.work for task in tasks}:
        located(work)
    key, count = max(Counter(task.key for task in tasks).items(), key=lambda item: item[1], default=("", 0))
    if count > 1:
        raise RequestError(f"{count} tasks have the key {key!r}")


@contextmanager
def _interruptible() -> Iterator[Callable[[], None]]:
    """Have SIGTERM raise KeyboardInterrupt as SIGINT does, where nothing else was arranged.

    Gives what raises it again if it was lost: Python drops what is raised while an object is destroyed.
    """
    struck = False

    def interrupt(_signal: int, _frame: FrameType | None) -> NoReturn:
        nonlocal struck
        struck = True
        raise KeyboardInterrupt

    def check_interrupt() -> None:
        if struck:
            raise KeyboardInterrupt

    usual: dict[int, Any] = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}
    in_main = threading.current_thread() is threading.main_thread()
    ours = {number: usual[number] for number in usual if in_main and signal.getsignal(number) is usual[number]}
    for number in ours:
        signal.signal(number, interrupt)
    try:
        yield check_interrupt
        check_interrupt()
    finally:
        for number, handler in ours.items():
            signal.signal(number, handler)
