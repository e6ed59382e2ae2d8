"""The method's open points, each a named field, settled three ways: TMPUD, PAPER and RELEASED.

The text of the paper leaves these points open; the authors' released research code settles some of them
differently from the text. ``docs/paper-to-code.md`` says where each field takes effect.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal, get_origin, get_type_hints

from tmpud.errors import RequestError


@dataclass(frozen=True, slots=True, kw_only=True)
class Preset:
    """One way to settle the open points. Every field has an effect; none is a special case in the code."""

    name: str

    # Utility (Sec. III)
    gamma: float = 4500.0  # [m] weight of the safety term
    constant_term: bool = False  # charge every action gamma/2 even where Safe is 1, as the formula literally does
    turn_cost: float = 0.0  # [m] added for each left or right turn

    # Safety estimation (Algorithm 1)
    aggregate: Literal["max+mean", "min+mean"] = "min+mean"  # over the instants of the horizon
    estimated: Literal["every action", "merges"] = "every action"
    lane_keeping: Literal["all vehicles", "conflicting vehicles"] = "conflicting vehicles"  # judged for non-merges
    share: Literal["exact", "sampled"] = "exact"
    samples: int = 1000  # M, used where share is "sampled"
    safety_distance: float = 8.0  # D [m]
    closing_weight: float = 1.0  # alpha [s*m]
    margin: float = 0.0  # eta [m^2/s]
    gate: float = 0.0  # the set is used where phi >= gate ...
    gate_rate: float = -math.inf  # ... and phi' > gate_rate
    strict_gate: bool = False  # phi > gate instead of >=
    acceleration: tuple[float, float] = (-6.0, 3.0)  # Delta [m/s^2]
    turning: Literal["steering", "yaw rate"] = "steering"  # what Theta is a range of
    turning_range: tuple[float, float] = (-0.1, 0.1)  # Theta [rad] or [rad/s]
    horizon: float | None = 4.0  # T [s]; None: until the goal pose at the first of ``ego_speeds``
    interval: float = 0.25  # omega [s]
    sensing_range: float = 30.0  # [m]
    neighbours: Literal["same level", "target lane"] = "same level"
    neighbour_heading: float = math.radians(120.0)  # [rad] vehicles turned further from the ego's are not looked at
    ego_speeds: tuple[float, ...] = ()  # [m/s] constant speeds, the worst counts; empty: the planned profile

    # The loop (Algorithm 2)
    cost_update: Literal["floored", "current pose", "never"] = "floored"
    unsafe_fallback: Literal["hold lane", "force"] = "hold lane"  # Threshold with no other plan left
    safe_expires: float | None = 30.0  # [s] simulated; None: never
    max_replans: int = 5  # plan changes without motion
    hysteresis: float = 0.01  # [m] a new plan must be better by at least this

    # States
    pose: Literal["canonical", "sampled"] = "canonical"
    segment_length: float = 60.0  # [m] longest segment; inf: one segment per lane

    def __post_init__(self) -> None:
        """Raise ValueError for a value that makes no sense in its field."""
        for field, (holds, sense) in _SENSE.items():
            if not holds(getattr(self, field)):
                raise ValueError(f"{field} is {getattr(self, field)}, and must be {sense}")
        if self.turning == "steering" and max(map(abs, self.turning_range)) >= math.pi / 2:
            raise ValueError(f"turning_range is {self.turning_range}, and must be within a right angle to steer by")


Sense = tuple[Callable[[Any], bool], str]  # whether a value makes sense, and which do

_MEASURE: Sense = (lambda value: 0 <= value < math.inf, "finite and not negative")
_NOT_NEGATIVE: Sense = (lambda value: value >= 0, "not negative")
_NUMBER: Sense = (lambda value: not math.isnan(value), "a number")
_SENSE: dict[str, Sense] = {
    **dict.fromkeys(("gamma", "turn_cost", "safety_distance", "closing_weight", "hysteresis"), _MEASURE),
    **dict.fromkeys(("sensing_range", "neighbour_heading", "max_replans"), _NOT_NEGATIVE),
    **dict.fromkeys(("gate", "gate_rate"), _NUMBER),
    "samples": (lambda value: value >= 1, "at least 1"),
    "margin": (math.isfinite, "finite"),
    "acceleration": (lambda ends: -math.inf < ends[0] <= ends[1] < math.inf, "low/high, both finite"),
    "turning_range": (
        lambda ends: -math.inf < ends[0] < ends[1] < math.inf,
        "low/high, finite and not one value",
    ),
    "horizon": (lambda value: value is None or 0 <= value < math.inf, "none, or finite and not negative"),
    "interval": (lambda value: 0 < value < math.inf, "finite and positive"),
    "ego_speeds": (lambda speeds: all(0 < speed < math.inf for speed in speeds), "finite and positive"),
    "safe_expires": (lambda value: value is None or value >= 0, "none, or not negative"),
    "segment_length": (lambda value: value > 0, "positive"),
}

TMPUD = Preset(name="tmpud")

PAPER = Preset(
    name="paper",
    gamma=2500.0,
    constant_term=True,
    aggregate="max+mean",
    lane_keeping="all vehicles",
    share="sampled",
    neighbour_heading=math.pi,
    cost_update="current pose",
    safe_expires=None,
    pose="sampled",
    segment_length=math.inf,
)

RELEASED = Preset(
    name="released",
    gamma=2500.0,
    turn_cost=25.0,
    estimated="merges",
    share="sampled",
    safety_distance=20.0,
    gate_rate=-0.5,
    strict_gate=True,
    acceleration=(0.0, 10.0),
    turning="yaw rate",
    turning_range=(-0.01, 0.01),
    horizon=None,
    interval=1.0,
    neighbours="target lane",
    neighbour_heading=math.radians(60.0),
    ego_speeds=(22.0 / 3.6, 26.0 / 3.6),
    cost_update="never",
    unsafe_fallback="force",
    safe_expires=None,
    max_replans=1000,
    hysteresis=0.0,
    segment_length=math.inf,
)

PRESETS = {preset.name: preset for preset in (TMPUD, PAPER, RELEASED)}


def preset_named(text: str) -> Preset:
    """Return a preset by its name, or a changed one such as ``tmpud:gamma=1500,turning_range=-0.2/0.2,horizon=none``.

    Raises RequestError for a name, field or value that there is not.
    """
    name, _, changes = text.partition(":")
    if name not in PRESETS:
        raise RequestError(f"no preset is called {name!r}; there are {', '.join(PRESETS)}")
    if not changes:
        return PRESETS[name]
    fields = dict(_change(text, change) for change in changes.split(","))
    try:
        return replace(PRESETS[name], name=text, **fields)
    except ValueError as error:
        raise RequestError(f"preset {text!r}: {error}") from None


def _change(preset: str, change: str) -> tuple[str, Any]:
    """Return the field and the value that ``field=value`` stands for."""
    from pydantic import TypeAdapter, ValidationError  # takes a while; only changed presets need it

    field, _, text = (part.strip() for part in change.partition("="))
    kinds = get_type_hints(Preset)
    if field == "name" or field not in kinds:
        raise RequestError(f"preset {preset!r}: {field!r} is no field; there are {', '.join(list(kinds)[1:])}")
    value = tuple(text.split("/")) if get_origin(kinds[field]) is tuple else None if text == "none" else text
    try:
        return field, TypeAdapter(kinds[field]).validate_python(value)
    except ValidationError as error:
        raise RequestError(f"preset {preset!r}: {change}: {error.errors()[0]['msg']}") from error
