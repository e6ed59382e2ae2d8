"""Two runs as one document: what sets them apart besides their algorithms, and where they parted."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

from tmpud.errors import RequestError
from tmpud.events import Estimated, Event, Executed, Planned
from tmpud.presets import Preset
from tmpud.scene import Outcome
from tmpud.story import plan_name
from tmpud.symbols import Transition
from tmpud.task.utility import penalty
from tmpud.viewer.document import SCHEMA, metre, milliseconds, replay_document
from tmpud.viewer.intact import Intact
from tmpud.viewer.memory import preset_of

SETTINGS = (  # of a mission that should be the same in both runs, and what follows where they are not
    ("seed", "the traffic is not the same"),
    ("traffic", "there are more vehicles in one"),
    ("start", "the roads driven are not the same"),
    ("via", "the roads driven are not the same"),
    ("goal", "the roads driven are not the same"),
    ("preset", "the open points of the method are settled otherwise"),
)


@dataclass(frozen=True, slots=True)
class _Driven:
    """An action of a run, how it was decided on, and what was known then."""

    step: Transition
    plan: int  # number of the plan that held it
    since: float  # [s] when the one before it had ended
    terms: tuple[float, float]  # [m] road and safety penalty of what is left of that plan
    safe: dict[Transition, float]  # what was estimated since then


def comparison_document(first: Intact, second: Intact) -> dict[str, Any]:
    """Return the document of two runs; their clocks both count from their own start. RequestError for two maps."""
    maps = [run.header.map for run in (first, second)]
    if maps[0].get("digest") != maps[1].get("digest"):
        named = (f"{town.get('name')!r} ({str(town.get('digest'))[:8]!r})" for town in maps)
        raise RequestError(f"only runs on the same map can be compared, not on {' and '.join(named)}")
    documents = [replay_document(run) for run in (first, second)]
    if documents[0]["ground"] is not None:
        documents[1]["ground"] = None  # the page takes the first one's
    return {
        "schema": SCHEMA,
        "runs": documents,
        "names": _names(first, second),
        "notices": list(_notices(first, second)),
        "parted": _parted(first, second),
    }


def _names(first: Intact, second: Intact) -> list[str]:
    """Return what tells the runs apart: the algorithms, or what else differs, or their order."""
    missions = [run.header.mission for run in (first, second)]
    names = [str(mission.get("algorithm")) for mission in missions]
    names = [_threshold(name, mission.get("beta")) for name, mission in zip(names, missions, strict=True)]
    for key in ("preset", "seed", "traffic"):
        if names[0] == names[1] and missions[0].get(key) != missions[1].get(key):
            names = [f"{name}, {key} {mission.get(key)}" for name, mission in zip(names, missions, strict=True)]
    return names if names[0] != names[1] else [f"{names[0]} (first)", f"{names[1]} (second)"]


def _threshold(name: str, beta: Any) -> str:
    return f"{name}({beta})" if name == "threshold" else name


def _notices(first: Intact, second: Intact) -> Iterator[str]:
    one, other = first.header.mission, second.header.mission
    for key, follows in SETTINGS:
        if one.get(key) != other.get(key):
            yield f"{key}: {_said(one.get(key))} and {_said(other.get(key))}, so {follows}"
    if one.get("preset") == other.get("preset") and one.get("settings") != other.get("settings"):
        yield "the presets of one name differ in their settings"
    changed = [name for name, version in first.header.versions.items() if second.header.versions.get(name) != version]
    if changed:
        yield f"other versions of {', '.join(map(str, changed))}"


def _said(value: Any) -> str:
    return " → ".join(map(str, value)) or "none" if isinstance(value, list | tuple) else str(value)


def _parted(first: Intact, second: Intact) -> dict[str, Any] | None:
    """Return the first action in which two runs differ, with what either knew of both; None where none differs."""
    for number, (one, other) in enumerate(zip_longest(_driven(first.events), _driven(second.events))):
        if one is None or other is None or one.step != other.step:
            steps = [driven.step for driven in (one, other) if driven is not None]
            sides = [(one, _weighing(first)), (other, _weighing(second))]
            return {"alike": number, "sides": [_side(driven, steps, preset) for driven, preset in sides]}
    return None


def _driven(events: Iterable[Event]) -> Iterator[_Driven]:
    """Yield the actions of a run in their order; one that nothing came of is none."""
    planned: Planned | None = None
    number, since = -1, 0.0
    safe: dict[Transition, float] = {}
    for event in events:
        match event:
            case Planned():
                planned, number = event, number + 1
                since = event.time if number == 0 else since
            case Estimated():
                safe[event.step] = event.safe
            case Executed() if planned is not None and event.outcome != Outcome.INFEASIBLE:
                yield _Driven(event.step, number, since, _terms(planned, event.step), safe)
                since, safe = event.time, {}


def _terms(planned: Planned, step: Transition) -> tuple[float, float]:
    first = planned.plan.index(step) if step in planned.plan else 0
    return math.fsum(map(float, planned.cost[first:])), math.fsum(map(float, planned.penalty[first:]))


def _side(driven: _Driven | None, steps: list[Transition], preset: Preset | None) -> dict[str, Any] | None:
    if driven is None:
        return None
    road, adds = driven.terms
    return {
        "time": milliseconds(driven.since),
        "action": driven.step.action,
        "from": driven.step.state.segment,
        "plan": plan_name(driven.plan),
        "number": driven.plan,
        "road": metre(road),
        "penalty": metre(adds),
        "safe": [_known(driven.safe.get(step), preset) for step in steps],
    }


def _weighing(run: Intact) -> Preset | None:
    """Return the preset of a run in which Safe counts as metres, None where it does not."""
    mission = run.header.mission
    try:
        return preset_of(mission["settings"]) if mission.get("algorithm") == "tmpud" else None
    except (KeyError, TypeError, ValueError):
        return None


def _known(safe: float | None, preset: Preset | None) -> list[float | None] | None:
    """Return Safe and the penalty it adds [m], None where it was not estimated."""
    return None if safe is None else [safe, None if preset is None else metre(penalty(safe, preset))]
