"""A run as one JSON document, all that the replay's page is told. Schema 3.

Times are whole milliseconds of simulated time, places whole centimetres, headings whole milliradians; lengths of
plans are metres, coefficients of safe control sets SI units.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

from tmpud.dynamics import EGO
from tmpud.events import Estimated, Executed, Finished, Judged, Planned
from tmpud.roads.network import RoadNetwork
from tmpud.story import plan_name
from tmpud.symbols import TaskPlan, Transition
from tmpud.viewer.changes import changes
from tmpud.viewer.ground import ground, line
from tmpud.viewer.intact import Intact
from tmpud.viewer.memory import preset_of
from tmpud.viewer.paths import Outlines
from tmpud.viewer.reasons import Change
from tmpud.viewer.sets import control_ranges, planes, predicted
from tmpud.viewer.traffic import columns

SCHEMA = 3
CAR = (5.0, 1.8)  # [m] length and width of SUMO's usual car: the log holds no sizes
TOLD = ("map", "start", "goal", "via", "algorithm", "beta", "traffic", "seed", "preset")


def replay_document(run: Intact) -> dict[str, Any]:
    """Return the document of a run, and add to its ``missing`` what cannot be shown."""
    outlines = Outlines(run)
    network, steps = outlines.network, _Steps(outlines)
    plans = [event for event in run.events if isinstance(event, Planned)]
    document = {
        "schema": SCHEMA,
        "mission": {key: _shown(run.header.mission.get(key)) for key in TOLD},
        "versions": {str(name): str(version) for name, version in run.header.versions.items()},
        "sizes": {"ego": [EGO.length, EGO.width], "car": CAR},
        "ground": ground(network) if network else None,
        "seen": columns(run.frames),
        "controls": _controls(run),
        "plans": [_planned(event, number, steps) for number, event in enumerate(plans)],
        "estimates": [_estimated(event, steps) for event in run.events if isinstance(event, Estimated)],
        "executed": [_executed(event) for event in run.events if isinstance(event, Executed)],
        "judged": [_judged(event) for event in run.events if isinstance(event, Judged)],
        "changes": [_change(change, steps) for change in _changes(run, network)],
        "finished": next((_finished(event) for event in run.events if isinstance(event, Finished)), None),
    }
    return {**document, "steps": steps.rows, "missing": run.missing}


class _Steps:
    """Numbers transitions in the order in which they are first met; each has a row [action, from, path]."""

    def __init__(self, outlines: Outlines) -> None:
        self.rows: list[list[Any]] = []
        self._numbers: dict[Transition, int] = {}
        self._outlines = outlines

    def __call__(self, step: Transition) -> int:
        if step not in self._numbers:
            self._numbers[step] = len(self.rows)
            self.rows.append([step.action, step.state.segment, line(self._outlines((step,)))])
        return self._numbers[step]

    def all(self, plan: TaskPlan) -> list[int]:
        return [self(step) for step in plan]


def _changes(run: Intact, network: RoadNetwork | None) -> list[Change]:
    try:
        preset = preset_of(run.header.mission["settings"])
        return list(changes(run.events, preset, _street_in(network)))
    except (KeyError, TypeError, ValueError) as error:
        run.missing.append(f"changes of plan cannot be explained: the header's settings cannot be read ({error!r})")
        return []


def _street_in(network: RoadNetwork | None) -> Callable[[str], str]:
    """Return what says the street of a lane, or the lane itself where it has no name."""
    lanes, names = (network.lanes, network.street_names) if network else ({}, {})
    return lambda lane: (names.get(lanes[lane].edge) if lane in lanes else None) or lane


def _controls(run: Intact) -> dict[str, Any] | None:
    try:
        return control_ranges(run.header.mission["settings"])
    except (KeyError, TypeError, ValueError) as error:
        run.missing.append(f"safe controls cannot be drawn: the header's settings cannot be read ({error!r})")
        return None


def _planned(event: Planned, number: int, steps: _Steps) -> dict[str, Any]:
    return {
        "name": plan_name(number),
        "time": milliseconds(event.time),
        "steps": steps.all(event.plan),
        "cost": _metres(event.cost),
        "penalty": _metres(event.penalty),
    }


def _estimated(event: Estimated, steps: _Steps) -> dict[str, Any]:
    return {
        "time": milliseconds(event.time),
        "step": steps(event.step),
        "safe": event.safe,
        "worst": event.worst,
        "ids": event.ids,
        "o": [[round(value, 3) for value in row] for row in event.o],
        "instants": [milliseconds(row[0]) for row in event.trajectory],
        "path": line((x, y) for _, x, y, _ in event.trajectory),
        "planes": planes(event),
        "others": predicted(event),
    }


def _executed(event: Executed) -> dict[str, Any]:
    return {"time": milliseconds(event.time), "outcome": event.outcome}


def _judged(event: Judged) -> dict[str, Any]:
    words = {name: getattr(event, name) for name in ("kind", "vehicle", "rule", "blame", "detail")}
    return {"time": milliseconds(event.time), **words}


def _finished(event: Finished) -> dict[str, Any]:
    words = {name: getattr(event, name) for name in ("status", "message", "distance")}
    return {"time": milliseconds(event.time), **words}


def _change(change: Change, steps: _Steps) -> dict[str, Any]:
    rows = [
        {
            "steps": steps.all(candidate.plan),
            "role": candidate.role,
            "length": metre(candidate.length),
            "turns": candidate.turns,
            "before": metre(candidate.before),
            "after": metre(candidate.after),
            "total": metre(candidate.total),
        }
        for candidate in change.candidates
    ]
    step = None if change.step is None else steps(change.step)
    told = {name: getattr(change, name) for name in ("headline", "words", "keep")}
    return {"plan": change.number, "step": step, "rows": rows, **told}


def _shown(value: Any) -> Any:
    """Return what the page may show of the mission: words, whole numbers and those that are finite."""
    if isinstance(value, list | tuple):
        return [str(item) for item in value]
    return value if isinstance(value, str | int) or (isinstance(value, float) and math.isfinite(value)) else None


def milliseconds(seconds: float) -> int:
    return round(seconds * 1000)


def _metres(values: Iterable[Any]) -> list[float | None]:
    return [metre(value) for value in values]


def metre(value: Any) -> float | None:
    """Return a length rounded to millimetres [m], None where there is none or it is not finite."""
    number = math.inf if value is None else float(value)
    return round(number, 3) if math.isfinite(number) else None
