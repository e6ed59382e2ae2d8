"""Learning the world models of the abstract simulation: forced merges under four road conditions (Sec. V).

Every merge is looked at with each preset's estimator, so the presets' models hold the same merges.
"""

from __future__ import annotations

import importlib.metadata
import json
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from tmpud.experiments.running.tasks import DONE, Json, Record, Task
from tmpud.experiments.statistics.intervals import wilson
from tmpud.experiments.worlds.merges import CONDITIONS, ROADS, LocalArea, local_chunk
from tmpud.experiments.worlds.models import FORMAT, LETTERS, preset_fields
from tmpud.presets import PRESETS
from tmpud.simulators.local import PlacementLaw

DIGITS = 4  # of Safe
_LOCAL = ("seed", "chunk", "roads")
_LETTER = {outcome: letter for letter, outcome in LETTERS.items()}


class LearningRuns:
    """Work: one chunk of merges under one condition."""

    isolated = False

    def prepare(self, shared: Json) -> dict[str, LocalArea]:
        """Return each preset's view of the local road."""
        return {name: LocalArea(PRESETS[name]) for name in shared["presets"]}

    def run(self, prepared: dict[str, LocalArea], arguments: Json) -> Json:
        """Return the outcomes and the presets' Safe of a chunk."""
        merges = list(local_chunk(CONDITIONS[arguments["condition"]], **{name: arguments[name] for name in _LOCAL}))
        safe = {}
        for name, area in prepared.items():
            rng = np.random.default_rng([arguments["seed"], arguments["chunk"]])
            safe[name] = [round(area.safe(merge.scene, rng), DIGITS) for merge in merges]
        return {"outcome": "".join(_LETTER[merge.outcome] for merge in merges), "safe": safe}


def tasks(merges: int, seed: int, roads: int = ROADS) -> list[Task]:
    """Return the tasks of at least ``merges`` merges per condition, in whole chunks of ``roads``."""
    shared = {"presets": sorted(PRESETS)}
    return [
        Task(
            key=f"{condition}/{chunk:04}",
            work="learn",
            shared=shared,
            arguments={"condition": condition, "chunk": chunk, "seed": seed, "roads": roads},
        )
        for condition in CONDITIONS
        for chunk in range(-(-merges // roads))
    ]


def world(records: Sequence[Record], *, merges: int, seed: int, command: str, time: str) -> dict[str, Any]:
    """Return the learned models with what they were made of; ``time`` is when they were made.

    Equal records give an equal world but for "made". A chunk that failed is missing from its condition's samples.
    """
    done = {record.key: record.result for record in records if record.status == DONE}
    rows: dict[str, list[Json]] = {condition: [] for condition in CONDITIONS}
    for key in sorted(done):
        rows[key.rpartition("/")[0]].append(done[key])
    versions = {name: importlib.metadata.version(name) for name in ("tmpud", "libsumo", "numpy")}
    return {
        "format": FORMAT,
        "made": {"command": command, "time": time, "versions": versions},
        "seed": seed,
        "merges": merges,
        "law": asdict(PlacementLaw()),
        "presets": {name: preset_fields(PRESETS[name]) for name in sorted(PRESETS)},
        "conditions": {name: {**asdict(CONDITIONS[name]), **_joined(chunks)} for name, chunks in rows.items()},
    }


def to_json(learned: dict[str, Any]) -> str:
    """Return a world as text."""
    return json.dumps(learned, indent=1, allow_nan=False) + "\n"


def _joined(chunks: Sequence[Json]) -> dict[str, Any]:
    """Return a condition's chunks as one: counts and shares of the outcomes, and the joint samples."""
    letters = "".join(chunk["outcome"] for chunk in chunks)
    shares = {outcome: wilson(letters.count(letter), len(letters)) for letter, outcome in LETTERS.items()}
    safe = {name: " ".join(_joined_safe(chunks, name)) for name in sorted(PRESETS)}
    return {
        "outcomes": {
            outcome: {"count": letters.count(_LETTER[outcome]), **share.to_json()} for outcome, share in shares.items()
        },
        "samples": {"outcome": letters, "safe": safe},
    }


def _joined_safe(chunks: Sequence[Json], preset: str) -> list[str]:
    return [f"{value:g}" for chunk in chunks for value in chunk["safe"][preset]]
