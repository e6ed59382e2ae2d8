"""Work that is quick, and work that misbehaves; named in tasks as ``tests.experiments.running.works:...``."""

from __future__ import annotations

import hashlib
import os
import signal
import socket
import stat
import threading
import time
from pathlib import Path
from typing import Any

from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.experiments.running.tasks import Json, Task

HERE = "tests.experiments.running.works"


def tasks(count: int, *, isolated: bool = False, group: int = 5, **arguments: Any) -> list[Task]:
    """Return well-behaved tasks, of which ``group`` start from the same."""
    return [task(f"{n:04d}", isolated=isolated, shared=n // group, seed=n, **arguments) for n in range(count)]


def task(key: str, *, isolated: bool = False, shared: int = 0, work: str = "", **arguments: Any) -> Task:
    """Return a task with a way to misbehave, if any, in its arguments."""
    name = work or ("Isolated" if isolated else "Quick")
    return Task(key=key, work=f"{HERE}:{name}", shared={"town": shared}, arguments=arguments)


class Quick:
    """Adds up what a task depends on; ``how`` it misbehaves, ``until`` a file is there, is in what it is given."""

    isolated = False

    def prepare(self, shared: Json) -> list[int]:
        misbehave(_how(shared))
        return [int(shared["town"])]

    def run(self, prepared: list[int], arguments: Json) -> Json:
        answer: Json | None = misbehave(_how(arguments))
        time.sleep(float(arguments.get("seconds", 0.0)))
        text = f"{prepared} {arguments.get('seed')} " + "x" * int(arguments.get("size", 0))
        if answer is not None:
            return answer
        return {"sum": hashlib.sha256(text.encode()).hexdigest(), "text": text, "pid": None}


class Isolated(Quick):
    """The same in a process of its own: each may spoil what was prepared."""

    isolated = True

    def run(self, prepared: list[int], arguments: Json) -> Json:
        result = super().run(prepared, arguments)
        prepared.append(1)
        return result


class Where(Quick):
    """Tells which process prepared a task and which ran it."""

    def prepare(self, shared: Json) -> list[int]:
        return [*super().prepare(shared), os.getpid()]

    def run(self, prepared: list[int], arguments: Json) -> Json:
        super().run(prepared, arguments)
        return {"prepared_in": prepared[1], "run_in": os.getpid()}


class WhereIsolated(Where):
    isolated = True


class Noting(Isolated):
    """Says which tasks left a note before it, and leaves one itself, be it that it crashes then."""

    def prepare(self, shared: Json) -> dict[str, int]:  # type: ignore[override]  # noqa: ARG002
        return {}

    def run(self, prepared: dict[str, int], arguments: Json) -> Json:  # type: ignore[override]
        before = list(prepared)
        prepared[str(arguments["seed"])] = 1
        misbehave(_how(arguments))
        return {"before": before}

    def notes(self, prepared: dict[str, int]) -> dict[str, int]:
        return prepared


class Threaded(Isolated):
    """Leaves a thread running, which a copy of the process would not have."""

    def prepare(self, shared: Json) -> list[int]:
        threading.Thread(target=time.sleep, args=(60.0,), daemon=True).start()
        return super().prepare(shared)


def _how(given: Json) -> str:
    healed = "until" in given and Path(given["until"]).exists()
    return "" if healed else str(given.get("how", ""))


def misbehave(how: str) -> Any:
    """Do something that a task must not do."""
    match how:
        case "crash":
            os.kill(os.getpid(), signal.SIGSEGV)
        case "exit":
            os._exit(3)
        case "leave":
            raise SystemExit(0)
        case "hang":
            time.sleep(3600.0)
        case "raise":
            raise ValueError(f"no\nsuch {object()}")
        case "garbage":
            write_garbage()
        case "simulator":
            raise SimulatorError("it has died")
        case "still":
            raise SimulatorHangError("it does not answer")
        case "nan":
            return {"distance": float("nan")}
        case "set":
            return {"lanes": {1, 2}}
        case "no mapping":
            return 7
        case "print":
            os.write(1, b'{"key": "0000", "status": "DONE", "result": {}}\n')
    return None


def write_garbage(data: bytes = b"\xff not json\n") -> None:
    """Write to every pipe and socket that this process has open."""
    for descriptor in range(3, 64):
        try:
            mode = os.fstat(descriptor).st_mode
            if stat.S_ISSOCK(mode):
                socket.socket(fileno=os.dup(descriptor)).sendall(data)
            elif stat.S_ISFIFO(mode):
                os.write(descriptor, data)
        except OSError:
            continue
