"""The learned world models as a file: joint samples of Safe and outcome for each road condition (Sec. V)."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tmpud.errors import RunFileError
from tmpud.execution.abstract import COLLIDE, MERGE, STOP, JointSample
from tmpud.presets import Preset

SHIPPED = "shipped"
_SHIPPED_FILE = Path(__file__).parent / "local.json"
FORMAT = "tmpud local world 1"
ESTIMATE = (  # the fields of a preset that decide about Safe
    "aggregate", "share", "samples", "safety_distance", "closing_weight", "margin", "gate", "gate_rate", "strict_gate",
    "acceleration", "turning", "turning_range", "horizon", "interval", "sensing_range", "neighbours",
    "neighbour_heading", "ego_speeds",
)  # fmt: skip
LETTERS = {"m": MERGE, "c": COLLIDE, "s": STOP}


def read_world(name: str | Path = SHIPPED) -> dict[str, Any]:
    """Return the shipped world, or that of a file; RunFileError where the file holds none."""
    path = _SHIPPED_FILE if name == SHIPPED else Path(name)
    try:
        world = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RunFileError(f"{path}: cannot be read as a learned world ({error})") from error
    if not isinstance(world, dict) or world.get("format") != FORMAT:
        raise RunFileError(f"{path}: not a file of format {FORMAT!r}; tmpud learn-world makes one")
    return world


def preset_fields(preset: Preset) -> dict[str, Any]:
    """Return a preset's fields as JSON holds them, those that are not finite as text."""
    return {name: _plain(value) for name, value in asdict(preset).items()}


def joint_sample(world: dict[str, Any], condition: str, preset: Preset) -> JointSample:
    """Return the pairs learnt under a road condition with a preset's estimate; RunFileError where there are none.

    A preset that differs from a learned one only in what does not touch the estimate has the learned one's pairs.
    """
    try:
        samples = world["conditions"][condition]["samples"]
        learned = next(name for name, fields in world["presets"].items() if _estimates_alike(fields, preset))
        safe = tuple(map(float, samples["safe"][learned].split()))
        return JointSample(safe, tuple(LETTERS[letter] for letter in samples["outcome"]))
    except (AttributeError, KeyError, StopIteration, TypeError, ValueError) as error:
        raise RunFileError(
            f"the learned world has no samples of {condition!r} for the preset {preset.name!r}"
        ) from error


def _estimates_alike(fields: dict[str, Any], preset: Preset) -> bool:
    mine = preset_fields(preset)
    return all(fields[name] == mine[name] for name in ESTIMATE)


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    return str(value) if value in (math.inf, -math.inf) else value
