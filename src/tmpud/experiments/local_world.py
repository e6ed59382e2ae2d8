"""The learned world models as a file: joint samples of Safe and outcome for each road condition (Sec. V)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tmpud.errors import RunFileError
from tmpud.execution.abstract import COLLIDE, MERGE, STOP, JointSample

SHIPPED = Path(__file__).parent.parent / "worlds" / "local.json"
FORMAT = "tmpud local world 1"
CONDITIONS = tuple(f"{d} density, {a} acceleration" for d in ("low", "high") for a in ("low", "high"))
LETTERS = {"m": MERGE, "c": COLLIDE, "s": STOP}


def read_world(path: Path = SHIPPED) -> dict[str, Any]:
    """Return the content of a learned world; RunFileError where the file holds none."""
    try:
        world = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunFileError(f"{path}: cannot be read as a learned world ({error})") from error
    if not isinstance(world, dict) or world.get("format") != FORMAT:
        raise RunFileError(f"{path}: not a file of format {FORMAT!r}; tmpud learn-world makes one")
    return world


def joint_sample(world: dict[str, Any], condition: str, preset: str) -> JointSample:
    """Return the pairs learnt under a road condition with a preset's estimate; RunFileError where there are none."""
    try:
        samples = world["conditions"][condition]["samples"]
        safe = tuple(map(float, samples["safe"][preset].split()))
        return JointSample(safe, tuple(LETTERS[letter] for letter in samples["outcome"]))
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise RunFileError(f"the learned world has no samples of {condition!r} for the preset {preset!r}") from error
