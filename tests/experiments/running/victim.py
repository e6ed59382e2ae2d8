"""A campaign made to be struck, which prints each key it was given back.

It is started by ``python -m tests.experiments.running.victim FOLDER``. What strikes it is in the environment, so that
the tasks, and with them the results, are always the same.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from tests.experiments.running.works import Quick, write_garbage
from tmpud.errors import TmpudError
from tmpud.experiments.running import store, workers
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.tasks import Json, Task
from tmpud.experiments.running.workers import Limits

PLAN = "TMPUD_TEST_PLAN"  # the variable with what strikes, as JSON; also the mark of all processes of a campaign
COUNT, GROUP, PAUSE = 20, 4, 0.01  # tasks; tasks that share; [s] of a task
POINTS: dict[str, tuple[Any, str, bool]] = {  # name -> whose function, its name, whether after it
    "before a write": (store, "_write", False),
    "after a write": (store, "_write", True),
    "after a sync": (store.Store, "append", True),
    "before a time": (store.Store, "note", False),
    "after a time": (store.Store, "note", True),
    "before the manifest": (store, "claim", False),
    "within the manifest": (Path, "replace", False),
    "after the manifest": (store, "claim", True),
    "before a start": (subprocess, "Popen", False),
    "after a start": (workers.Worker, "__init__", True),
    "before a hand-over": (workers.Worker, "_hand_over", False),
    "after a hand-over": (workers.Worker, "_hand_over", True),
    "before a worker's end": (workers.Worker, "end", False),
    "within a write": (store, "_write", False),
    "before the tail is cut": (os, "ftruncate", False),
    "after the tail is cut": (os, "ftruncate", True),
}
ONCE = {"before the manifest", "within the manifest", "after the manifest", "before the tail is cut",
        "after the tail is cut"}  # fmt: skip


def todo(isolated: bool) -> list[Task]:
    """Return the tasks of every campaign of this kind."""
    work = f"tests.experiments.running.victim:{'Isolated' if isolated else 'Shared'}"
    return [
        Task(key=f"{n:04d}", work=work, shared={"town": n // GROUP}, arguments={"seed": n, "key": f"{n:04d}"})
        for n in range(COUNT)
    ]


class Shared(Quick):
    """Quick work in which a blow may fall, once."""

    def prepare(self, shared: Json) -> list[int]:
        _in_work("prepare", f"{GROUP * shared['town']:04d}")
        return super().prepare(shared)

    def run(self, prepared: list[int], arguments: Json) -> Json:
        if plan().get("stuck") and int(arguments["key"]) % 3 == 2:
            time.sleep(3600.0)
        time.sleep(PAUSE)
        for moment in ("run", "half an answer", "after"):
            _in_work(moment, arguments["key"])
        return super().run(prepared, arguments)


class Isolated(Shared):
    isolated = True


def plan() -> dict[str, Any]:
    return dict(json.loads(os.environ.get(PLAN, "{}")))


def _in_work(moment: str, key: str) -> None:
    """Let the blow fall that is planned for this moment of this task, unless it has fallen."""
    blow = plan().get("work")
    if not blow or (blow["moment"], blow["key"]) != (moment, key):
        return
    try:
        Path(blow["mark"]).touch(exist_ok=False)
    except FileExistsError:
        return
    line = _ancestry(os.getpid())
    victims = {"task": line[:1], "worker": line[-2:-1], "supervisor": line[-1:], "both": line[-2:], "all": line[::-1]}
    if moment == "half an answer":
        write_garbage(b'{"key": "%s", "status": "DONE", "res' % key.encode())
    if moment == "after":  # once the answer is on its way
        if os.fork():
            return
        time.sleep(PAUSE)
    for process in victims[blow["whom"]]:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    os._exit(0)


def _ancestry(process: int) -> list[int]:
    """Return the process, its parent, ... up to the supervisor."""
    line = [process]
    while b"tests.experiments.running.victim" not in Path(f"/proc/{line[-1]}/cmdline").read_bytes():
        line.append(int(Path(f"/proc/{line[-1]}/stat").read_text().rpartition(")")[2].split()[1]))
    return line


def _arrange(point: str, nth: int, both: bool) -> None:
    """Have this process kill itself, and its workers if both, at the nth time it comes to a point."""
    owner, name, after = POINTS[point]
    original: Callable[..., Any] = getattr(owner, name)
    calls = count(1)

    def struck(*arguments: Any, **named: Any) -> Any:
        now = next(calls) == nth
        if now and point == "within a write":
            original(arguments[0], arguments[1][: len(arguments[1]) // 2])
        if now and not after:
            _fall(both)
        result = original(*arguments, **named)
        if now:
            _fall(both)
        return result

    setattr(owner, name, struck)


def _fall(both: bool) -> None:
    if both:
        for child in Path(f"/proc/self/task/{os.getpid()}/children").read_text().split():
            os.kill(int(child), signal.SIGKILL)
    os.kill(os.getpid(), signal.SIGKILL)


def main() -> int:
    arranged = plan()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever started this may have had it ignored
    if "point" in arranged:
        _arrange(**arranged["point"])
    if "full" in arranged:
        resource.setrlimit(resource.RLIMIT_FSIZE, (arranged["full"], arranged["full"]))
    experiment = Experiment(name="victim", options={})
    try:
        for record in run_campaign(
            Path(sys.argv[1]),
            experiment,
            todo(arranged.get("isolated", False)),
            limits=Limits(jobs=2, recycle_after=2 * GROUP),
        ):
            print(record.key, flush=True)  # noqa: T201
    except KeyboardInterrupt:
        return 130
    except TmpudError as error:
        sys.stderr.write(f"tmpud: {error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
