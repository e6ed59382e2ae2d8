"""The supervisor: hands tasks to workers, listens to them, and replaces those that crash or hang."""

from __future__ import annotations

import math
import selectors
import time
from collections import Counter, deque
from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import IO, Any

from tmpud.errors import SimulatorError
from tmpud.experiments.running.tasks import DONE, ERROR, SIM_CRASH, SIM_HANG, Json, Record, Task, digest
from tmpud.experiments.running.workers import Limits, Worker

ATTEMPTS = 2  # at a task that crashes or hangs
FALSE_STARTS = 5  # workers in a row that end before they are ready
NOTICING = 1.0  # [s] for a worker whose socket is closed to end


@dataclass(frozen=True, slots=True)
class Finished:
    """A task that ended, with wall-clock times [s] where it gave an answer."""

    record: Record
    timing: Json


def chunks(tasks: Sequence[Task], limits: Limits) -> Iterator[list[Task]]:
    """Yield tasks that start from the same, in parts where they are many.

    They are dealt out like cards: those that take long often stand together, and every part has some of them.
    """
    groups: dict[str, list[Task]] = {}
    for task in tasks:
        groups.setdefault(digest([task.work, task.shared]), []).append(task)
    share = len(tasks) if limits.together else math.ceil(len(tasks) / limits.jobs)
    longest = min(limits.recycle_after, share)
    for group in groups.values():
        parts = math.ceil(len(group) / longest)
        yield from (group[first::parts] for first in range(parts))


class Supervisor:
    """Does tasks on workers."""

    def __init__(self, tasks: Sequence[Task], limits: Limits, log: IO[bytes]) -> None:
        self._queue = deque(chunks(tasks, limits))
        self._limits, self._log = limits, log
        self._workers: list[Worker] = []
        self._faults: Counter[str] = Counter()  # attempts at a task that crashed or hung
        self._false_starts = 0
        self._prepared: dict[Worker, float] = {}

    def run(self) -> Generator[list[Finished]]:
        """Yield what ended, as it ends; nothing goes on where nobody asks for more, and no worker stays after."""
        try:
            while True:
                self._hand_out()
                if not any(worker.tasks for worker in self._workers):
                    return
                if finished := self._listen():
                    yield finished
        finally:
            for worker in self._workers:
                worker.end()

    def _hand_out(self) -> None:
        """Replace workers that have done enough, and give those with nothing to do the next tasks."""
        for worker in [worker for worker in self._workers if not worker.tasks]:
            if not self._queue:
                return
            if worker.done + len(self._queue[0]) > self._limits.recycle_after:
                self._dismiss(worker)
            else:
                worker.give(self._queue.popleft())
        while self._queue and len(self._workers) < self._limits.jobs:
            worker = Worker(self._log, self._limits)
            self._workers.append(worker)
            worker.give(self._queue.popleft())

    def _listen(self) -> list[Finished]:
        """Wait for answers, or until a worker has taken too long; what a worker has said counts before its limit."""
        now = time.monotonic()
        patience = max(0.0, min(worker.left(now) for worker in self._workers))
        with selectors.DefaultSelector() as selector:
            for worker in self._workers:
                selector.register(worker, selectors.EVENT_READ, worker)
            heard = [key.data for key, _ in selector.select(patience)]
        finished = [ended for worker in heard for ended in self._hear(worker)]
        now = time.monotonic()
        for worker in [worker for worker in self._workers if worker not in heard and worker.left(now) <= 0.0]:
            limit = self._limits.task if worker.phase == "running" else self._limits.prepare
            finished += self._lose(worker, SIM_HANG, f"no answer within {limit:g} s while {worker.phase}")
        return finished

    def _hear(self, worker: Worker) -> list[Finished]:
        """Take what a worker says; one that ended or talks nonsense is lost."""
        finished: list[Finished] = []
        try:
            for answer in worker.answers():
                finished += self._take(worker, answer)
        except EOFError:
            finished += self._lose(worker, SIM_CRASH, "")
        except (ValueError, RecursionError):
            finished += self._lose(worker, SIM_CRASH, "garbage instead of an answer")
        return finished

    def _take(self, worker: Worker, answer: Json) -> list[Finished]:
        match worker.phase, answer:
            case "starting", {"ready": True}:
                self._false_starts = 0
                worker.ready()
            case "preparing", {"prepared": float(seconds)}:
                self._prepared[worker] = seconds
                worker.prepared()
            case "preparing", {"unprepared": str(message)}:
                tasks = list(worker.tasks)
                return [_faulty(worker.finished(), ERROR, message) for _ in tasks]
            case "running", {"key": worker.next_key, "status": str(status), "result": dict(result)}:
                return self._end(worker, status, result, answer.get("seconds"))
            case _:
                raise ValueError("an answer to nothing that was asked")
        return []

    def _end(self, worker: Worker, status: str, result: Json, seconds: Any) -> list[Finished]:
        """Take the answer to the task that a worker runs."""
        if status not in (DONE, ERROR, SIM_CRASH, SIM_HANG):
            raise ValueError("no status")
        task = worker.finished()
        if status in (SIM_CRASH, SIM_HANG):
            return self._blame([task], status, str(result.get("message")))
        return [_finished(task, status, result, {"seconds": seconds, "prepared": self._prepared.pop(worker, 0.0)})]

    def _lose(self, worker: Worker, status: str, message: str) -> list[Finished]:
        """End a worker and blame it on what it did: on one task, or on all that were to start from the same."""
        tasks, phase = worker.tasks, worker.phase
        how = self._dismiss(worker, 0.0 if message else NOTICING)
        if phase == "starting":
            self._false_starts += 1
            if self._false_starts > FALSE_STARTS:
                raise SimulatorError(f"worker processes do not start ({message or how}); see {self._log.name}")
        if phase in ("starting", "idle"):
            self._queue.extendleft([tasks] if tasks else [])
            return []
        blamed, rest = (tasks[:1], tasks[1:]) if phase == "running" else (tasks, [])
        self._queue.extendleft([rest] if rest else [])
        return self._blame(blamed, status, message or f"{how} while {phase}")

    def _blame(self, tasks: Sequence[Task], status: str, message: str) -> list[Finished]:
        """Have tasks that crashed or hung tried again, once."""
        self._faults.update(task.key for task in tasks)
        again = [task for task in tasks if self._faults[task.key] < ATTEMPTS]
        self._queue.extendleft([again] if again else [])
        return [_faulty(task, status, message) for task in tasks if self._faults[task.key] >= ATTEMPTS]

    def _dismiss(self, worker: Worker, patience: float = 0.0) -> str:
        self._workers.remove(worker)
        self._prepared.pop(worker, None)
        return worker.end(patience)


def _faulty(task: Task, status: str, message: str) -> Finished:
    return _finished(task, status, {"message": message}, {})


def _finished(task: Task, status: str, result: Json, timing: Json) -> Finished:
    return Finished(Record(key=task.key, digest=task.digest, status=status, result=result), {"key": task.key, **timing})
