"""One trial of an experiment driven once more, with all that can be seen in it, and compared with what was kept."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tmpud.errors import RequestError
from tmpud.events import Event, Frame
from tmpud.experiments.kinds import KINDS
from tmpud.experiments.running.manifest import code_digest
from tmpud.experiments.running.store import Results
from tmpud.experiments.running.tasks import DONE, Record, Task, digest
from tmpud.experiments.trials.full import summary
from tmpud.presets import preset_named
from tmpud.recording import record
from tmpud.roads.loading import load_map
from tmpud.runner import Mission, drive


@dataclass(frozen=True, slots=True)
class Trial:
    """What was driven, and what was kept of it."""

    mission: Mission
    record: Record

    @property
    def stamp(self) -> str:
        """Another one where the trial, the map or the code that drives it is another."""
        town = load_map(self.mission.map, preset_named(self.mission.preset).segment_length)
        return digest([self.record.key, self.record.digest, dict(self.record.result), town.digest, code_digest()])


def trial_of(results: Results, key: str) -> Trial:
    """Return the trial of a key; RequestError where there is none that can be driven again."""
    name = results.manifest["experiment"]
    if name not in KINDS or (cells := KINDS[name].cells) is None:
        raise RequestError(f"nothing of {name!r} can be driven again: its trials are not driven in traffic")
    known = {record.key: record for record in results.records}
    for cell in cells(results.manifest["options"]):
        if cell.task.key == key and key in known and known[key].digest == cell.task.digest:
            _refuse_a_server(cell.task)
            return Trial(mission_of(cell.task), known[key])
    raise RequestError(f"no trial {key!r} has ended here; one is called {next(iter(known), 'nothing yet')}")


def _refuse_a_server(task: Task) -> None:
    """Raise RequestError for a trial on a CARLA server: nobody's map is replaced because somebody opened a page."""
    if server := task.shared.get("server"):
        raise RequestError(
            f"it was driven on the CARLA server {server}, which would load a map for it and drop what is on it. "
            f"Where that may be: {shlex.join(_command(task, server))}"
        )


def _command(task: Task, server: str) -> list[str]:
    """Return the command that drives a trial on a server."""
    told = {name: value for name, value in {**task.shared, **task.arguments}.items() if name != "server"}
    host, _, port = server.rpartition(":")
    places = {"from": told.pop("start"), "to": told.pop("goal")}
    via = [f"--via={place}" for place in told.pop("via", ())]
    words = {"sim": "carla", "host": host, "port": port, **places, **told}
    return ["tmpud", "drive", *(f"--{name}={value}" for name, value in words.items()), *via]


def mission_of(task: Task) -> Mission:
    """Return what a task of full simulation drives."""
    told = {**task.shared, **task.arguments}
    return Mission(**{**told, "via": tuple(told.get("via", ()))})


def drive_again(trial: Trial, folder: Path) -> Iterator[Event]:
    """Drive a trial into a run folder, and yield its events."""
    return record(drive(trial.mission), folder)


def differences(trial: Trial, events: Iterable[Event]) -> list[str]:
    """Return in words what of the trial's result came out otherwise."""
    if trial.record.status != DONE:
        return [f"it ended in a tool fault, {trial.record.status}, and has no result to compare with"]
    now: dict[str, Any] = json.loads(json.dumps(summary(event for event in events if not isinstance(event, Frame))))
    kept = trial.record.result
    return [f"{name}: {kept[name]} was kept, {now.get(name)} came now" for name in kept if kept[name] != now.get(name)]


def caveats(results: Results) -> list[str]:
    """Return why a trial may come out otherwise here."""
    before, now = results.manifest.get("code"), code_digest()
    return [] if before == now else [f"the results are by other code of tmpud ({before}; this is {now})"]
