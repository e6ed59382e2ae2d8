"""A short run in the shipped town, made up: plan A is given up for plan B, the traffic moves, one moment is unsafe."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Plane, Planned, Refused
from tmpud.presets import TMPUD
from tmpud.recording import record
from tmpud.roads.loading import load_map
from tmpud.symbols import Action, State, TaskPlan, Transition
from tmpud.task.utility import penalty

START, SAFE, LONGER = 10.0, 0.5, 12.5  # [s], Safe of the refused merge, [m] by which plan B is longer
SHARES = ((1.0, 0.5, 0.3, 0.7, 1.0), (1.0, 1.0, 0.8, 0.9, 1.0))  # o_i(t) of the refused merge


def plan(*steps: tuple[str, str, str]) -> TaskPlan:
    return tuple(Transition(State(here, 0), Action(action), State(there, 0)) for here, action, there in steps)


MERGE_NOW = plan(
    ("park1e_0/0", "mergeleft", "park1e_1/1"), ("park1e_1/1", "forward", "park2e_1/0"),
    ("park2e_1/0", "forward", "park2e_1/1"),
)  # fmt: skip
MERGE_LATER = plan(
    ("park1e_0/0", "forward", "park1e_0/1"), ("park1e_0/1", "forward", "park2e_0/0"),
    ("park2e_0/0", "mergeleft", "park2e_1/1"),
)  # fmt: skip
PLACE = {"name": "park1e_0", "segments": ["park1e_0/0"], "station": None}
GOAL = {"name": "park2e_1", "segments": ["park2e_1/1"], "station": None}


@cache
def digest() -> str:
    return load_map("millbrook").digest


def header(**mission: Any) -> Header:
    told = {
        "map": "millbrook", "start": "park1e_0", "goal": "park2e_1", "via": [], "algorithm": "tmpud", "beta": 0.3,
        "traffic": 2, "seed": 1, "preset": "tmpud", "request": {"start": PLACE, "goals": [GOAL]},
        "settings": asdict(TMPUD),
    }  # fmt: skip
    return Header(0.0, {"tmpud": "0"}, {"name": "millbrook", "digest": digest()}, {**told, **mission})


def planned(time: float, steps: TaskPlan, cost: float, others: Mapping[TaskPlan, float], reason: str) -> Planned:
    """Return a plan whose cost is spread evenly; the others cost what the refused merge adds, where they begin so."""
    listed = tuple((other, length, _risk(other, reason)) for other, length in others.items())
    share = cost / len(steps)
    return Planned(time, 0, steps, (share,) * len(steps), (0.0,) * len(steps), listed, reason)


def _risk(steps: TaskPlan, reason: str) -> float:
    return penalty(SAFE, TMPUD) if steps[0] == MERGE_NOW[0] and reason != "start" else 0.0


def frame(number: int, names: Iterable[str] = ("car1", "car2"), signals: Mapping[str, str] | None = None) -> Frame:
    ids = tuple(names)
    rows = tuple((5000 + 90 * number + 700 * i, 29745, 0, 900) for i in range(len(ids)))
    lit = {"mill_park": "GGgrrGGG" if number < 20 else "yyyrryyy"}
    return Frame(round(START + 0.1 * (number + 1), 3), (4267 + 50 * number, 29425, 1, 500), ids, rows, signals or lit)


def plane(share: float) -> Plane:
    """Return a tilted cut that leaves a share, from 0.06 to 0.94, of the preset's controls."""
    low, high = TMPUD.acceleration
    return None if share == 1.0 else (low + share * (high - low), 1.0, 5.0)


def decision(risk: str = "car1") -> list[Event]:
    """Return how plan A is given up for plan B."""
    trajectory = tuple((0.25 * i, 42.7 + 1.25 * i, 294.2 + 0.2 * i, 0.1) for i in range(5))
    planes = tuple(tuple(map(plane, row)) for row in SHARES)
    others = ((42.0, 297.45, 0.0, 9.0, 0.0), (49.0, 297.45, 0.0, 9.0, 0.1))
    return [
        planned(START, MERGE_NOW, 300.0, {MERGE_LATER: 300.0 + LONGER}, "start"),
        Estimated(START, MERGE_NOW[0], SAFE, risk, 0.3, (risk, "car2"), SHARES, trajectory, others, planes),
        Refused(START, MERGE_NOW[0], SAFE, "Safe(mergeleft) = 0.50"),
        planned(START, MERGE_LATER, 300.0 + LONGER, {MERGE_NOW: 300.0}, "Safe(mergeleft) = 0.50"),
    ]


def events(**mission: Any) -> list[Event]:
    return [
        header(**mission),
        *decision(),
        *(frame(number) for number in range(40)),
        Judged(13.0, "forced_stop", "car2", "merge", "ego", "0.9 m/s behind the ego"),
        Executed(14.0, MERGE_LATER[0], "done", True, 40.0),
        Finished(14.0, "SUCCESS", "", 40.0, 4.0, 1, {"collisions": 0}),
    ]


def merging(**mission: Any) -> list[Event]:
    """Return the run of a driver that keeps plan A: it merges, and collides after a second."""
    return [
        header(**{"algorithm": "no-com", **mission}),
        planned(START, MERGE_NOW, 300.0, {MERGE_LATER: 300.0 + LONGER}, "start"),
        *(frame(number) for number in range(10)),
        Judged(11.0, "collision", "car1", "merge", "ego", "5 m/s, 1.0 s after the start of merge"),
        Executed(11.0, MERGE_NOW[0], "collide", False, 5.0),
        Finished(11.0, "COLLISION", "", 5.0, 1.0, 0, {"collisions": 1}),
    ]


def recorded(folder: Path, log: Iterable[Event] | None = None) -> Path:
    for _ in record(iter(events() if log is None else log), folder):
        pass
    return folder
