"""What an experiment is made of: tasks that are known before it runs, and a record of how each ended."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from tmpud.errors import RequestError

Json = Mapping[str, Any]  # only what JSON holds: strings, finite numbers, truth values, None, lists and mappings

DONE = "DONE"  # a record's status where the task gave a result
SIM_CRASH, SIM_HANG, ERROR = "SIM_CRASH", "SIM_HANG", "ERROR"  # ended unasked, took too long, raised
TOOL_FAULTS = (SIM_CRASH, SIM_HANG, ERROR)  # a record's status where it did not; never an outcome of driving


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One thing to run; the same task gives the same result, whoever runs it and whatever ran before."""

    key: str  # unique in its experiment, such as "heavy/0017/tmpud"
    work: str  # a name in ``WORK``, or "module:class"
    shared: Json  # tasks of equal work and shared are run one after another on one prepared state
    arguments: Json

    @property
    def digest(self) -> str:
        """Tell tasks apart that have the same key: a record counts only for the task it was made of."""
        return digest({"work": self.work, "shared": self.shared, "arguments": self.arguments})


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """How a task ended. Wall-clock times are kept elsewhere, so that equal tasks have equal records."""

    key: str
    digest: str  # the task's
    status: str  # DONE or one of TOOL_FAULTS
    result: Json  # empty where the status is a tool fault, but for "message"


class Work(Protocol):
    """What can be done with tasks; implemented by a class without arguments, made once in a worker process.

    Its ``__init__`` imports what is heavy. Where it is not isolated, ``run`` must leave what was prepared as it is.
    """

    isolated: bool  # whether each task needs a process of its own, forked from the prepared one

    def prepare(self, shared: Json) -> Any:
        """Return what several tasks start from, such as a running town."""
        ...

    def run(self, prepared: Any, arguments: Json) -> Json:
        """Do one task; what it raises is a tool fault, and a SimulatorError a crash or hang: tried once more."""
        ...


@runtime_checkable
class NotingWork(Work, Protocol):
    """Isolated work whose tasks leave notes for those after them, to spare them time but to change no result."""

    def notes(self, prepared: Any) -> dict[Any, Any]:
        """Return the notes, to which ``run`` adds; what it adds in its copy of what was prepared is carried over."""
        ...


WORK: dict[str, str] = {  # name -> "module:class", imported where it is run
    "full": "tmpud.experiments.trials.full:FullTrials",
    "carla": "tmpud.experiments.trials.carla:CarlaTrials",
    "abstract": "tmpud.experiments.trials.abstract:AbstractTrials",
    "learn": "tmpud.experiments.worlds.learning:LearningRuns",
    "merge scenes": "tmpud.experiments.calibration.scenes:MergeScenes",
    "local merge scenes": "tmpud.experiments.calibration.scenes:LocalMergeScenes",
}


def located(work: str) -> str:
    """Return "module:class" of a work, given by its name or so; RequestError where there is none."""
    if ":" not in work and work not in WORK:
        raise RequestError(f"no work is called {work!r}; there are {', '.join(WORK)}")
    return WORK.get(work, work)


def digest(value: Any) -> str:
    """Return a digest of a JSON value that depends on nothing but the value."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def results_hash(records: Iterable[Record]) -> str:
    """Return one hash over all results, whatever order they came in."""
    rows = sorted((record.key, record.digest, record.status, digest(record.result)) for record in records)
    return digest(rows)
