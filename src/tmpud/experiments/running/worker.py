"""A worker process does groups of tasks, one after another.

It is started by ``python -m tmpud.experiments.running.worker SOCKET PARENT``. A group comes as one line of JSON and
is answered by a line that says it is prepared and a line for each task, in their order. They go over a socket of
their own: whatever simulators print goes to the log.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import pickle
import re
import resource
import signal
import socket
import sys
import time
import traceback
from collections.abc import Callable
from functools import cache, partial
from typing import Any

from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.experiments.running.processes import die_with, ending, exit_code, fork, threads
from tmpud.experiments.running.tasks import DONE, ERROR, SIM_CRASH, SIM_HANG, Json, NotingWork, Work, located

GARBAGE = 10_000  # objects made, then the youngest are looked through: tasks make many and hardly any cycles
ADDRESS = re.compile(r"0x[0-9a-f]+")  # of an object: another in each process
Send = Callable[[Json], None]
Run = Callable[[Work, Any, Json], Json]


def main() -> None:
    descriptor, parent = int(sys.argv[1]), int(sys.argv[2])
    die_with(parent)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the supervisor decides what an interrupt ends
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    gc.set_threshold(GARBAGE)
    with socket.socket(fileno=descriptor) as connection, connection.makefile("rb") as groups:
        send = partial(_send, connection)
        send({"ready": True})
        for line in groups:
            _do(json.loads(line), send, descriptor)


def _do(group: Json, send: Send, descriptor: int) -> None:
    """Do a group of tasks, and end as the process ends that is forked for it, if one is."""
    try:
        work = _work(group["work"])
        _check_threads(work)
    except Exception as error:
        send({"unprepared": _message(error)})
        return
    if not work.isolated:
        _each(work, _prepared_once, _here, group, send)
        return
    code = exit_code(fork(partial(_each, work, _prepared, partial(_in_child, descriptor), group, send)))
    if code < 0:
        os.kill(os.getpid(), -code)
    if code:
        sys.exit(code)


def _each(work: Work, prepare: Callable[[Work, str], Any], run: Run, group: Json, send: Send) -> None:
    began = time.monotonic()
    try:
        prepared = prepare(work, json.dumps(group["shared"]))
        _check_threads(work)
    except Exception as error:
        send({"unprepared": _message(error)})
        return
    if work.isolated:
        gc.freeze()  # what all tasks share: no child looks for garbage there
    send({"prepared": time.monotonic() - began})
    for task in group["tasks"]:
        began = time.monotonic()
        answer = run(work, prepared, task["arguments"])
        send({"key": task["key"], "seconds": time.monotonic() - began, **answer})


@cache
def _work(name: str) -> Work:
    """Return the work of a name, made once: what its ``__init__`` imports is there for all later tasks."""
    module, _, kind = located(name).partition(":")
    work: Work = getattr(importlib.import_module(module), kind)()
    return work


def _prepared(work: Work, shared: str) -> Any:
    return work.prepare(json.loads(shared))


_last: dict[tuple[Work, str], Any] = {}


def _prepared_once(work: Work, shared: str) -> Any:
    """Return what was prepared for the group before, where it is the same."""
    if (work, shared) not in _last:
        _last.clear()
        _last[work, shared] = _prepared(work, shared)
    return _last[work, shared]


def _here(work: Work, prepared: Any, arguments: Json) -> Json:
    """Run one task in this process."""
    try:
        result = dict(work.run(prepared, arguments))
        json.dumps(result, allow_nan=False)
    except Exception as error:
        return {"status": _status(error), "result": {"message": _message(error)}}
    return {"status": DONE, "result": result}


def _status(error: Exception) -> str:
    if isinstance(error, SimulatorHangError):
        return SIM_HANG
    return SIM_CRASH if isinstance(error, SimulatorError) else ERROR


def _in_child(connection: int, work: Work, prepared: Any, arguments: Json) -> Json:
    """Run one task in a copy of this process, so that nothing it does can touch the next but by its notes."""
    reading, writing = os.pipe()

    def run() -> None:
        os.close(connection)
        with os.fdopen(writing, "wb") as pipe:
            pipe.write(json.dumps(_here(work, prepared, arguments)).encode() + b"\n")
            if isinstance(work, NotingWork):
                pickle.dump(work.notes(prepared), pipe)

    child = fork(run)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        data, _, notes = pipe.read().partition(b"\n")
    code = exit_code(child)
    try:
        answer = json.loads(data)
        whole = not code and {"status", "result"} == set(answer)
    except (ValueError, TypeError, RecursionError):
        whole = False
    if not whole:
        return {"status": SIM_CRASH, "result": {"message": ending(code) if code else "garbage instead of a result"}}
    if isinstance(work, NotingWork):
        work.notes(prepared).update(pickle.loads(notes))  # noqa: S301  our own copy wrote them
    return dict(answer)


def _send(connection: socket.socket, answer: Json) -> None:
    connection.sendall(json.dumps(answer, allow_nan=False).encode() + b"\n")


def _check_threads(work: Work) -> None:
    if work.isolated and threads() > 1:
        raise RuntimeError(f"{threads()} threads run where a process is to be forked, which would have only one")


def _message(error: Exception) -> str:
    """Return an exception as one line that is the same in every process; the traceback goes to the log."""
    traceback.print_exception(error)
    return ADDRESS.sub("0x...", " ".join(f"{type(error).__name__}: {error}".split()))


if __name__ == "__main__":
    main()
