"""Worker processes as their supervisor sees them: started, given chunks of tasks, ended for sure."""

from __future__ import annotations

import json
import math
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import IO, NoReturn

from tmpud.experiments.running.processes import ending
from tmpud.experiments.running.tasks import Json, Task

ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}  # workers fork
SENDING = 10.0  # [s] for a worker that is ready to take its tasks


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """How the work is spread and when it is given up; nothing of it changes a result."""

    jobs: int = 1  # worker processes at a time
    task: float = 600.0  # [s] wall clock, then a task hangs
    prepare: float = 600.0  # [s] for what tasks share, and for a worker to start
    recycle_after: int = 200  # tasks, then a worker is replaced
    together: bool = True  # tasks that start from the same stay with one worker, whoever else has nothing to do


class Worker:
    """One process and the tasks it was given; ``tasks[0]`` is under way."""

    def __init__(self, log: IO[bytes], limits: Limits) -> None:
        self.tasks: list[Task] = []
        self.phase = "starting"  # "idle", "preparing" or "running"
        self.done = 0  # tasks
        self._limits, self._buffer = limits, b""
        self._socket, other = socket.socketpair()
        with other:
            self._process = subprocess.Popen(  # noqa: S603  our own module
                [sys.executable, "-P", "-m", "tmpud.experiments.running.worker", str(other.fileno()), str(os.getpid())],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, pass_fds=[other.fileno()], process_group=0,
                env={**os.environ, **ONE_THREAD, "PYTHONPATH": _import_path()},
            )  # fmt: skip
        self._enter("starting")

    @property
    def next_key(self) -> str | None:
        """The key of the task under way."""
        return self.tasks[0].key if self.tasks else None

    def fileno(self) -> int:
        return self._socket.fileno()

    def give(self, tasks: Sequence[Task]) -> None:
        """Have an idle worker do tasks of equal work and shared; one that starts gets them when it is ready."""
        self.tasks = list(tasks)
        if self.phase == "idle":
            self._hand_over()

    def answers(self) -> Iterator[Json]:
        """Yield what the worker has said; EOFError where it has ended, ValueError where it makes no sense."""
        try:
            data = self._socket.recv(1 << 20)
        except ConnectionError as error:
            raise EOFError from error
        if not data:
            raise EOFError
        *lines, self._buffer = (self._buffer + data).split(b"\n")
        for line in lines:
            answer = json.loads(line, parse_constant=_refuse)
            if not isinstance(answer, dict):
                raise ValueError("not an answer")
            yield answer

    def ready(self) -> None:
        """Note that the worker has started."""
        self._enter("idle")
        if self.tasks:
            self._hand_over()

    def prepared(self) -> None:
        """Note that what its tasks share is there."""
        self._enter("running")

    def finished(self) -> Task:
        """Note that its task is done; return it."""
        self.done += 1
        task = self.tasks.pop(0)
        self._enter("running" if self.tasks else "idle")
        return task

    def left(self, now: float) -> float:
        """Return how long [s] it may still take for what it does."""
        return self._until - now

    def end(self, patience: float = 0.0) -> str:
        """Kill the process and all that it forked; return how it ended, if it does so within ``patience`` [s]."""
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(patience)
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._socket.close()
        return ending(self._process.wait())

    def _hand_over(self) -> None:
        first = self.tasks[0]
        tasks = [{"key": task.key, "arguments": task.arguments} for task in self.tasks]
        group = {"work": first.work, "shared": first.shared, "tasks": tasks}
        self._enter("preparing")
        self._socket.settimeout(SENDING)
        with suppress(OSError):  # it has died: that is noticed when it is listened to
            self._socket.sendall(json.dumps(group, allow_nan=False).encode() + b"\n")
        self._socket.settimeout(None)

    def _enter(self, phase: str) -> None:
        limits = {"idle": math.inf, "running": self._limits.task}
        self.phase, self._until = phase, time.monotonic() + limits.get(phase, self._limits.prepare)


def _refuse(number: str) -> NoReturn:
    raise ValueError(f"{number} is no number of JSON")


def _import_path() -> str:
    """Return the path on which a worker finds the same modules as this process."""
    return os.pathsep.join(folder or os.getcwd() for folder in sys.path)
