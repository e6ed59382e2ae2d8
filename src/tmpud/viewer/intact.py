"""Reads what is intact of a run, and says what is missing."""

from __future__ import annotations

import gzip
import json
import math
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tmpud.errors import RunFileError
from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Planned, Refused, from_json
from tmpud.recording import LOG, no_run
from tmpud.symbols import TaskPlan, Transition
from tmpud.viewer import traffic


@dataclass(slots=True)
class Intact:
    """The events of a run that can be shown."""

    header: Header
    events: list[Event] = field(default_factory=list)  # the header and the frames left out
    frames: list[Frame] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)  # for people


def read_intact(folder: Path) -> Intact:
    """Read a run folder; RunFileError where there is no run, or not even its first line can be read."""
    damaged: list[str] = []
    cut: list[int] = []
    lines = _events(folder / LOG, damaged, cut)
    header = next(lines, None)
    if not isinstance(header, Header):
        why = f"damaged: {damaged[0]}" if damaged else "it has only begun, or was cut off" if cut else "it is empty"
        raise RunFileError(f"{folder / LOG}:1: no header, so it cannot be told what was run; {why}")
    run = Intact(header)
    for event in lines:
        if isinstance(event, Frame):
            if run.frames and event.time <= run.frames[-1].time:
                damaged.append(f"the frame of {event.time} s, which is out of order")
            else:
                run.frames.append(event)
        elif not isinstance(event, Header):
            run.events.append(event)
    run.missing += _told(damaged)
    if not run.frames:
        run.missing.append("no frames were recorded, so no traffic can be shown")
    if not any(isinstance(event, Finished) for event in run.events):
        after = f" after line {cut[0]} of its log" if cut else ""
        run.missing.append(f"the run has no end: it is still going on, or was cut off{after}")
    return run


def _events(path: Path, damaged: list[str], cut: list[int]) -> Iterator[Event]:
    """Yield the events that are sound; note the others in ``damaged``, and in ``cut`` after which line the log ends.

    A log that is still being written ends in the middle of its compressed stream, just as one that was cut off.
    """
    number = 0
    try:
        with gzip.open(path, "rt", encoding="utf-8", errors="replace") as log:
            for number, line in enumerate(log, 1):
                event = read_event(line)
                if event is None:
                    damaged.append(f"line {number}")
                else:
                    yield event
    except (FileNotFoundError, NotADirectoryError) as error:
        raise RunFileError(no_run(path)) from error
    except EOFError:
        cut.append(number)
    except (OSError, zlib.error) as error:
        damaged.append(f"everything after line {number} ({error})")


def read_event(line: str) -> Event | None:
    """Return the event on a line; None where there is none, or not one that can be shown."""
    try:
        event = from_json(json.loads(line))
        return event if sound(event) else None
    except (RunFileError, ValueError, TypeError, AttributeError, RecursionError):
        return None


def _told(damaged: list[str]) -> list[str]:
    if not damaged:
        return []
    more = f" and {len(damaged) - 3} more" if len(damaged) > 3 else ""
    return [f"damaged in the log and left out: {', '.join(damaged[:3])}{more}"]


def sound(event: Event) -> bool:
    """Whether an event read from a file has values of the kinds it should have."""
    if not (_number(event.time) and 0 <= event.time < traffic.MOST / 1000):
        return False
    match event:
        case Frame():
            return traffic.sound(event)
        case Header(mission=mission, map=town, versions=versions):
            return all(isinstance(part, Mapping) for part in (mission, town, versions))
        case Planned(plan=plan, cost=cost, penalty=penalty, alternatives=others, reason=reason):
            listed = all(_plan(p) and _real(c, s) for p, c, s in others)
            return (
                _plan(plan)
                and len(plan) == len(cost) == len(penalty)
                and _real(*cost, *penalty)
                and listed
                and _text(reason)
            )
        case Estimated(ids=ids, o=o, trajectory=path):
            shaped = len(ids) == len(o) and len({len(row) for row in o}) <= 1 and all(len(row) == 4 for row in path)
            numbers = all(_small(value) for rows in (o, path) for row in rows for value in row)
            named = _text(*ids) and (event.worst is None or _text(event.worst))
            return shaped and numbers and named and _step(event.step) and _share(event.safe) and _made_of(event)
        case Refused(step=step, safe=safe, reason=reason):
            return _step(step) and _share(safe) and _text(reason)
        case Executed(step=step, outcome=outcome, distance=distance):
            return _step(step) and _text(outcome) and _number(distance)
        case Judged(kind=kind, vehicle=vehicle, rule=rule, blame=blame, detail=detail):
            return _text(kind, rule, blame, detail) and (vehicle is None or _text(vehicle))
        case Finished(status=status, message=message, metrics=metrics):
            return (
                _text(status, message)
                and _number(event.distance)
                and _number(event.travel_time)
                and isinstance(metrics, Mapping)
            )
    return False


def _made_of(event: Estimated) -> bool:
    """Whether the vehicles and sets of an estimate fit its shares, or are left out as in schema 1."""
    others, planes = event.others, event.planes
    states = all(len(row) == 5 and all(_small(value) for value in row) for row in others)
    shaped = [len(row) for row in planes] == [len(row) for row in event.o] or not planes
    coefficients = [value for row in planes for plane in row if plane for value in plane]
    sets = all(_number(value) or value == -math.inf for value in coefficients)
    return states and len(others) in (0, len(event.ids)) and shaped and sets


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _small(value: Any) -> bool:
    """Whether it is a number that positions can be computed from."""
    return _number(value) and abs(value) < traffic.MOST


def _real(*values: Any) -> bool:
    """Whether all are numbers; those that are not finite are written as words."""
    return all(_number(value) or value in ("inf", "-inf") for value in values)


def _share(value: Any) -> bool:
    return _number(value) and 0 <= value <= 1


def _text(*values: Any) -> bool:
    return all(isinstance(value, str) for value in values)


def _step(step: Transition) -> bool:
    return (
        _text(step.state.segment, step.next_state.segment) and _number(step.state.leg) and _number(step.next_state.leg)
    )


def _plan(plan: TaskPlan) -> bool:
    return all(map(_step, plan))
