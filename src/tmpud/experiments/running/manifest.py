"""What a results folder belongs to: one experiment with its options, tasks, code and versions."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import os
import platform
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import tmpud
from tmpud.errors import FolderError, RunFileError
from tmpud.experiments.running.tasks import Json, Task, digest

MANIFEST = "manifest.json"
SCHEMA = 1
KEYS = {"experiment", "options", "tasks", "versions", "code", "command", "begun"}
PACKAGES = ("tmpud", "clingo", "libsumo", "numpy")
SHOWS_ONLY = (  # files that read results and cannot change them
    "cli/", "story.py", "viewer/", "server/", "experiments/again", "experiments/kinds", "experiments/reports/",
    "experiments/running/progress", "experiments/statistics/cells", "experiments/statistics/claims",
    "experiments/statistics/pairing",
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Experiment:
    """What is run."""

    name: str
    options: Json  # all that decides about results, so not the number of jobs
    command: str = ""  # for readers


def describe(experiment: Experiment, tasks: Sequence[Task]) -> dict[str, Any]:
    """Return the manifest of an experiment that begins now."""
    keys = sorted((task.key, task.digest) for task in tasks)
    return {
        "schema": SCHEMA,
        "experiment": experiment.name,
        "options": json.loads(json.dumps(experiment.options, allow_nan=False)),
        "tasks": {"count": len(keys), "digest": digest(keys)},
        "versions": {name: importlib.metadata.version(name) for name in _packages(experiment)}
        | {"python": platform.python_version()},
        "code": code_digest(),
        "command": experiment.command,
        "begun": datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ"),
    }


def _packages(experiment: Experiment) -> tuple[str, ...]:
    """Return what decides about results; a CARLA server is refused that is not of its client's version."""
    return (*PACKAGES, "carla") if experiment.options.get("server") else PACKAGES


def claim(folder: Path, manifest: Json) -> None:
    """Make the folder the experiment's; FolderError where it is another's."""
    if (folder / MANIFEST).exists():
        if different := _difference(read_manifest(folder), manifest):
            raise FolderError(f"{folder}: {different}; choose another folder, or repeat what this one was begun with")
        return
    draft = folder / f"{MANIFEST}.part"
    with draft.open("w", encoding="utf-8") as file:
        file.write(json.dumps(manifest, indent=1, sort_keys=True) + "\n")
        file.flush()
        os.fsync(file.fileno())
    draft.replace(folder / MANIFEST)
    sync_folder(folder)


def read_manifest(folder: Path) -> dict[str, Any]:
    """Return what a results folder belongs to; RunFileError where that cannot be read."""
    file = folder / MANIFEST
    try:
        manifest = json.loads(file.read_bytes())
    except (FileNotFoundError, NotADirectoryError) as error:
        raise RunFileError(f"{folder}: no results: there is no {MANIFEST}") from error
    except (OSError, ValueError) as error:
        raise RunFileError(f"{file}: cannot be read ({error})") from error
    if not isinstance(manifest, dict) or manifest.get("schema") != SCHEMA or not manifest.keys() >= KEYS:
        raise RunFileError(f"{file}: not a manifest of schema {SCHEMA}")
    return manifest


def code_digest() -> str:
    """Return a digest of the package's files, but for those that cannot change a result."""
    root = Path(tmpud.__file__).parent
    total = hashlib.sha256()
    for name, file in sorted((file.relative_to(root).as_posix(), file) for file in _files(root)):
        if not name.startswith(SHOWS_ONLY):
            total.update(f"{name}\0{hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()[:16]


def sync_folder(folder: Path) -> None:
    """Make the names of new files last."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _files(root: Path) -> Iterable[Path]:
    return (file for file in root.rglob("*") if file.is_file() and "__pycache__" not in file.parts)


def _difference(old: Json, new: Json) -> str | None:
    """Say in one line in what two manifests differ; None where one can continue the other."""
    if old.get("experiment") != new["experiment"]:
        return f"holds results of {old.get('experiment')!r}, not of {new['experiment']!r}"
    for part, name in (("options", "option "), ("versions", "")):
        before, now = old.get(part, {}), new[part]
        changed = sorted(key for key in {*before, *now} if before.get(key) != now.get(key))
        if changed:
            differing = (f"{name}{key} {before.get(key)!r} (now {now.get(key)!r})" for key in changed)
            return f"was begun with {', '.join(differing)}"
    if old.get("code") != new["code"]:
        return f"was begun with other code of tmpud ({old.get('code')}, now {new['code']})"
    if old.get("tasks") != new["tasks"]:
        return f"was begun with other tasks ({old.get('tasks')}, now {new['tasks']})"
    return None
