"""A run told in words, and summed up in one object."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from typing import Any

from tmpud.events import Estimated, Event, Executed, Finished, Header, Judged, Planned, Refused
from tmpud.symbols import TaskPlan, Transition

SUMMARY_VERSION = 1  # of what ``summarise`` returns
MEASURED = (  # metrics that a drive may be without, and how they are shown
    ("min_ttc", "time to collision", "at least {min_ttc:.1f} s"),
    ("rms_jerk", "jerk", "root mean square {rms_jerk:.1f} m/s^3, max {max_jerk:.1f} m/s^3"),
)


class Story:
    """Tells events as lines of text, in their order; remembers the names of the plans it has told of."""

    def __init__(self) -> None:
        self._plans = 0

    def tell(self, event: Event) -> list[str]:
        """Return what is to be said of an event; nothing for what only a picture can show."""
        clock = f"{event.time:7.1f} s  "
        match event:
            case Header(mission=mission):
                return _opening(event.map["name"], mission)
            case Planned():
                self._plans += 1
                return [clock + line for line in _plan_lines(event, plan_name(self._plans - 1))]
            case Estimated(step=step, safe=safe, worst=worst):
                return [
                    f"{clock}estimate  {said(step)}: Safe = {safe:.2f}" + (f"  (nearest risk {worst})" if worst else "")
                ]
            case Refused(step=step, reason=reason):
                return [f"{clock}refused   {said(step)}: {reason}"]
            case Executed(step=step, outcome=outcome, distance=distance):
                return [f"{clock}drove     {said(step)}: {outcome}, {distance:.0f} m so far"]
            case Judged(kind=kind, vehicle=vehicle, detail=detail, blame=blame):
                return [f"{clock}JUDGED    {kind} {vehicle or ''} (blame: {blame}) {detail}"]
            case Finished(status=status, message=message):
                return [f"{clock}{status}" + (f": {message}" if message else "")]
        return []


def _opening(town: str, mission: Any) -> list[str]:
    stops = " -> ".join((mission["start"], *mission["via"], mission["goal"]))
    who = mission["algorithm"] + (f"({mission['beta']:g})" if mission["algorithm"] == "threshold" else "")
    how = f"preset {mission['preset']}, {mission['traffic']} vehicles, seed {mission['seed']}"
    return [f"{town}: {stops}", f"{who}, {how}", ""]


def _plan_lines(event: Planned, name: str) -> list[str]:
    total = f"{event.cost_m:.0f} m + {event.penalty_m:.0f} m safety penalty"
    why = "" if event.reason == "start" else f" (because {event.reason})"
    lines = [f"plan {name}    {total}{why}", f"          {actions(event.plan)}"]
    for plan, cost, penalty in event.alternatives[:2]:
        lines.append(f"          next best: {cost:.0f} m + {penalty:.0f} m: {actions(plan)}")
    return lines


def plan_name(number: int) -> str:
    """Return A, B, ..., Z, A1, B1, ... for 0, 1, ..."""
    turn, letter = divmod(number, 26)
    return chr(ord("A") + letter) + (str(turn) if turn else "")


def said(step: Transition) -> str:
    return f"{step.action} {step.state.segment} -> {step.next_state.segment}"


def actions(plan: TaskPlan) -> str:
    """Return a plan's actions, repetitions counted."""
    runs = [(action.value, len(list(run))) for action, run in groupby(step.action for step in plan)]
    return ", ".join(name if count == 1 else f"{name} x{count}" for name, count in runs) or "nothing to do"


def summarise(events: Iterable[Event]) -> dict[str, Any]:
    """Return a run as one JSON object: how it ended, what was planned and what was estimated."""
    summary: dict[str, Any] = {"schema_version": SUMMARY_VERSION, "plans": [], "estimates": [], "judged": []}
    for event in events:
        match event:
            case Header(mission=mission):
                summary["seed"] = mission["seed"]
            case Planned():
                summary["plans"].append(_plan_summary(event))
            case Estimated(step=step, safe=safe):
                lane, _, _ = step.state.segment.rpartition("/")
                summary["estimates"].append({"action": step.action.value, "lane": lane, "safe": round(safe, 6)})
            case Judged():
                summary["judged"].append(_plain(event))
            case Finished():
                summary |= {
                    "status": event.status,
                    "message": event.message,
                    "distance_m": round(event.distance, 2),
                    "travel_time_s": round(event.travel_time, 2),
                    "replans": event.replans,
                    **event.metrics,
                }
    return summary


def _plain(event: Judged) -> dict[str, Any]:
    names = ("time", "kind", "vehicle", "rule", "blame", "detail")
    return {name: getattr(event, name) for name in names}


def _plan_summary(event: Planned) -> dict[str, Any]:
    return {
        "actions": [step.action.value for step in event.plan],
        "cost_m": round(event.cost_m, 2),
        "penalty_m": round(event.penalty_m, 2),
    }


def closing(summary: dict[str, Any]) -> list[str]:
    """Return the table that ends a story."""
    rows = [
        ("status", summary["status"]),
        ("distance", f"{summary['distance_m']:.0f} m"),
        ("travel time", f"{summary['travel_time_s']:.0f} s"),
        ("collisions", summary["collisions"]),
        ("forced stops", summary["forced_stops"]),
        ("rules broken", summary["violations"]),
        ("replans", summary["replans"]),
    ]
    rows += [(name, words.format(**summary)) for key, name, words in MEASURED if key in summary]
    rows += [
        (f"{kind} latency", f"median {ms['median']:.2f} ms, max {ms['max']:.2f} ms, n = {ms['n']:.0f}")
        for kind, ms in summary["latency_ms"].items()
    ]
    return ["", *(f"  {name:<18}{value}" for name, value in rows)]
