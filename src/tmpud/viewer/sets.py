"""What an estimate was made of: the ranges of the controls, the safe control sets, and the predicted paths."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tmpud.events import Estimated
from tmpud.safety import control_set
from tmpud.scene import Body, Vehicles
from tmpud.trajectory import predict
from tmpud.viewer.ground import line
from tmpud.viewer.memory import preset_of

NONE_SAFE = -1e9  # [m^2/s] a limit that no control meets, where the log's is -inf


def control_ranges(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return Delta, Theta and the aggregate of a header's settings; raises KeyError, TypeError or ValueError."""
    preset = preset_of(settings)
    controls = control_set.controls(preset)
    ranges = {"acceleration": _range(controls.acceleration), "turning": _range(controls.turning)}
    return {**ranges, "steering": controls.steering, "aggregate": preset.aggregate}


def _range(ends: tuple[float, float]) -> list[float]:
    low, high = map(float, ends)
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ValueError(f"{ends} is no range that can be drawn")
    return [low, high]


def planes(event: Estimated) -> list[list[list[float] | None]]:
    """Return the half-planes (N, T) as the page is told them: null where every control is safe."""
    return [[plane and [max(value, NONE_SAFE) for value in plane] for plane in row] for row in event.planes]


def predicted(event: Estimated) -> list[list[int]]:
    """Return where each vehicle was predicted to be at the instants, as lines."""
    cars = [Body(x, y, 0.0, heading, speed, yaw_rate, 0.0, 0.0, 0.0) for x, y, heading, speed, yaw_rate in event.others]
    if not cars:
        return []
    paths = predict(Vehicles(event.ids, event.ids, cars), np.array([row[0] for row in event.trajectory])).places
    return [line((place.real, place.imag) for place in path) for path in paths.tolist()]
