"""What an experiment is made of: tasks that are known before it runs, and a record of how each ended."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

Json = Mapping[str, Any]  # only what JSON holds: strings, finite numbers, truth values, None, lists and mappings

DONE = "DONE"  # a record's status where the task gave a result
TOOL_FAULTS = ("SIM_CRASH", "SIM_HANG", "ERROR")  # ... and where it did not; never counted as an outcome of driving


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """One thing to run; the same task gives the same result, whoever runs it and whatever ran before."""

    key: str  # unique in its experiment, such as "heavy/0017/tmpud"
    work: str  # a name in ``WORK``
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
    """What can be done with tasks; implemented by a class without arguments."""

    isolated: bool  # whether each task needs a process of its own, forked from the prepared one

    def prepare(self, shared: Json) -> Any:
        """Return what several tasks start from, such as a running town."""
        ...

    def run(self, prepared: Any, arguments: Json) -> Json:
        """Do one task; what it raises is a tool fault."""
        ...


WORK: dict[str, str] = {  # name -> "module:class", imported where it is run
    "full": "tmpud.experiments.full:FullTrials",
}


def digest(value: Any) -> str:
    """Return a digest of a JSON value that depends on nothing but the value."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def results_hash(records: Iterable[Record]) -> str:
    """Return one hash over all results, whatever order they came in."""
    rows = sorted((record.key, record.digest, record.status, digest(record.result)) for record in records)
    return digest(rows)
