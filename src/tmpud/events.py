"""A run as a stream of events: what was planned, estimated, refused, done and judged, and what could be seen.

Schema 2. An event is one JSON object on a line; ``event`` names its class, the other keys are the fields below.
A transition is ``[segment, leg, action, next segment, next leg]``. Lengths in ``Frame`` are whole centimetres, angles
whole milliradians, speeds whole cm/s; everything else is in SI units; a number that is not finite
is a string, "inf" or "-inf". Wall-clock times are not events. Logs of schema 1, whose estimates have neither
``others`` nor ``planes``, are read as well.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from tmpud.errors import RunFileError
from tmpud.showing import ShownAsHtml
from tmpud.symbols import Action, State, TaskPlan, Transition

SCHEMA_VERSION = 2
Plane = tuple[float, float, float] | None  # limit, by_acceleration, by_turning of safety.control_set.HalfPlane


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened at a simulated time [s]."""

    time: float


@dataclass(frozen=True, slots=True)
class Header(Event):
    """What was run, so that it can be run again."""

    versions: Mapping[str, str]
    map: Mapping[str, Any]  # name, digest, offset, projection
    mission: Mapping[str, Any]  # start, goals, algorithm, beta, traffic, seed, preset's fields, dt
    schema_version: int = SCHEMA_VERSION


@dataclass(frozen=True, slots=True)
class Planned(Event, ShownAsHtml):
    """The task planner's answer, its terms per transition, and the next best plans."""

    leg: int
    plan: TaskPlan
    cost: tuple[float, ...]  # [m] per transition
    penalty: tuple[float, ...]  # [m] per transition
    alternatives: tuple[tuple[TaskPlan, float, float], ...]  # (plan, cost [m], penalty [m])
    reason: str  # "start", or what made it plan anew

    @property
    def cost_m(self) -> float:
        return sum(self.cost)

    @property
    def penalty_m(self) -> float:
        return sum(self.penalty)


@dataclass(frozen=True, slots=True)
class Estimated(Event):
    """Algorithm 1's answer for one action in one snapshot."""

    step: Transition
    safe: float
    worst: str | None
    min_t: float
    ids: tuple[str, ...]  # (N,)
    o: tuple[tuple[float, ...], ...]  # (N, T)
    trajectory: tuple[tuple[float, float, float, float], ...]  # (T, 4) t, x, y, heading of the ego
    others: tuple[tuple[float, float, float, float, float], ...] = ()  # (N, 5) x, y, heading, speed, yaw rate
    planes: tuple[tuple[Plane, ...], ...] = ()  # (N, T) U_i^S(t); None: every control is safe


@dataclass(frozen=True, slots=True)
class Refused(Event):
    """An action that is not taken: its Safe led to another plan."""

    step: Transition
    safe: float
    reason: str


@dataclass(frozen=True, slots=True)
class Executed(Event):
    """An action that was driven, and how it ended."""

    step: Transition
    outcome: str
    estimated: bool  # whether an estimate of the snapshot it began in preceded it
    distance: float  # [m] driven since the start


@dataclass(frozen=True, slots=True)
class Frame(Event):
    """Everything on the road at one instant; rows are ``[x, y, heading, speed]`` in cm, cm, mrad, cm/s."""

    ego: tuple[int, int, int, int]
    ids: tuple[str, ...]
    others: tuple[tuple[int, int, int, int], ...]
    signals: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Judged(Event):
    """A collision, a forced stop or a broken rule of the road."""

    kind: str
    vehicle: str | None
    rule: str
    blame: str
    detail: str


@dataclass(frozen=True, slots=True)
class Finished(Event):
    """How the run ended, in one named status."""

    status: str
    message: str
    distance: float  # [m]
    travel_time: float  # [s]
    replans: int
    metrics: Mapping[str, float] = field(default_factory=dict)


_KINDS: dict[str, type[Event]] = {
    kind.__name__: kind for kind in (Header, Planned, Estimated, Refused, Executed, Frame, Judged, Finished)
}


def to_json(event: Event) -> dict[str, Any]:
    """Return an event as a JSON object."""
    plain = _same if isinstance(event, Frame) else _plain  # a frame is whole numbers and letters already
    values = {f.name: _WRITE.get(f.name, plain)(getattr(event, f.name)) for f in fields(event)}
    return {"event": type(event).__name__, **values}


def from_json(row: Mapping[str, Any]) -> Event:
    """Return the event a JSON object stands for; RunFileError where it stands for none."""
    try:
        values = dict(row)
        kind = _KINDS[values.pop("event")]
        return kind(**{name: _RESTORE.get(name, _tuples)(value) for name, value in values.items()})
    except (KeyError, TypeError, ValueError) as error:
        raise RunFileError(f"not an event of schema {SCHEMA_VERSION}: {error}") from error


def _same(value: Any) -> Any:
    return value


def _plain(value: Any) -> Any:
    if isinstance(value, Transition):
        return [*value.state, value.action.value, *value.next_state]
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else str(value)
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return value


def _significant(planes: tuple[tuple[Plane, ...], ...]) -> list[list[list[float | str] | None]]:
    """Keep six digits of each coefficient, whatever its size: the share in a half-plane then errs by about 1e-5."""
    return [[plane and [_six(value) for value in plane] for plane in row] for row in planes]


def _six(value: float) -> float | str:
    return float(f"{value:.6g}") if math.isfinite(value) else str(value)


def _tuples(value: Any) -> Any:
    if not isinstance(value, list):
        return value
    return tuple([_tuples(item) if isinstance(item, list) else item for item in value])  # a log holds millions


def _transition(row: list[Any]) -> Transition:
    segment, leg, action, next_segment, next_leg = row
    return Transition(State(segment, leg), Action(action), State(next_segment, next_leg))


def _plan(rows: list[list[Any]]) -> TaskPlan:
    return tuple(_transition(row) for row in rows)


def _planes(rows: list[list[list[Any] | None]]) -> tuple[tuple[Plane, ...], ...]:
    return tuple(tuple(None if plane is None else _plane(*plane) for plane in row) for row in rows)


def _plane(limit: Any, by_acceleration: Any, by_turning: Any) -> Plane:
    return float(limit), float(by_acceleration), float(by_turning)


_WRITE: dict[str, Any] = {"planes": _significant}

_RESTORE: dict[str, Any] = {
    "step": _transition,
    "plan": _plan,
    "planes": _planes,
    "alternatives": lambda rows: tuple((_plan(plan), cost, penalty) for plan, cost, penalty in rows),
}
