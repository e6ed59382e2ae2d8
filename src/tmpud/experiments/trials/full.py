"""One trial in full simulation, and what is kept of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

from tmpud.errors import SimulatorError
from tmpud.events import Estimated, Event, Executed, Finished, Judged, Refused
from tmpud.execution.memory import Memory, RecalledWorld, RecordedWorld, UnknownError
from tmpud.experiments.running.tasks import SIM_CRASH, Json
from tmpud.judging.rules import Kind
from tmpud.presets import preset_named
from tmpud.protocols import Simulator
from tmpud.roads.loading import load_map
from tmpud.runner import Mission, WorldFactory, drive, sumo
from tmpud.simulators import sumo_process

RISKY = 0.5  # a merge driven below this Safe was a risk that the algorithm knew of

MEASURED = ("min_ttc", "rms_jerk", "max_jerk")  # [s], [m/s^3], [m/s^3]; None where there was nothing to measure


class Town(NamedTuple):
    """A town in which traffic runs, not yet entered by the ego."""

    mission: Mission
    simulator: Simulator
    known: dict[Mission, Memory]  # mission but for the algorithm -> what came of each drive in it so far


class FullTrials:
    """Trials by several algorithms in the very same traffic: each goes on from one running town, in its own process.

    An algorithm that decides as another did before it ends as that one did, and needs no simulation of its own.
    """

    isolated = True

    def __init__(self) -> None:
        """Import the simulator once for all towns that are forked from this process."""
        sumo_process.imported()

    def prepare(self, shared: Json) -> Town:
        """Return the town once its traffic flows."""
        mission = Mission(**{**shared, "via": tuple(shared.get("via", ()))})
        network = load_map(mission.map, preset_named(mission.preset).segment_length)
        return Town(mission, sumo(network, mission), {})

    def run(self, prepared: Town, arguments: Json) -> Json:
        """Drive one trial with the algorithm and preset of the arguments."""
        mission = replace(prepared.mission, **arguments)
        memory = prepared.known.setdefault(replace(mission, algorithm="", beta=0.0), {})
        try:
            result = self._summary(mission, prepared, partial(RecalledWorld, memory))
        except UnknownError:
            result = self._summary(mission, prepared, partial(RecordedWorld, memory))
        if result["status"] == SIM_CRASH:
            raise SimulatorError(result["message"])
        return result

    def notes(self, prepared: Town) -> dict[Mission, Memory]:
        return prepared.known

    def _summary(self, mission: Mission, town: Town, world: WorldFactory) -> dict[str, Any]:
        return summary(drive(mission, simulator=lambda *_: town.simulator, frames=False, alternatives=0, world=world))


def summary(events: Iterable[Event]) -> dict[str, Any]:
    """Return what a table, a test of a claim and a look into a bad trial need of a run."""
    safe: dict[Any, float] = {}
    merges: list[float | None] = []  # Safe of each merge driven; None where nobody asked
    collisions: Counter[str] = Counter()
    kinds: Counter[str] = Counter()
    refused = 0
    for event in events:
        match event:
            case Estimated():
                safe[event.step] = round(event.safe, 6)
            case Refused():
                refused += 1
            case Executed():
                known = safe.get(event.step) if event.estimated else None
                merges += [known] if event.step.action.is_merge else []
            case Judged():
                kinds[event.kind] += 1
                collisions[event.rule] += event.kind == Kind.COLLISION
            case Finished():
                end = event
    stops = int(end.metrics["forced_stops"])  # none where the trial ended in a collision
    return {
        "status": end.status,
        "message": end.message,
        "distance": round(end.distance, 3),
        "travel_time": round(end.travel_time, 3),
        "unsafe": bool(collisions["merge"] or stops),
        "collisions": {name: n for name, n in sorted(collisions.items()) if n},
        "forced_stops": stops,
        "hard_brakings": kinds[Kind.HARD_BRAKING],
        "violations": int(end.metrics["violations"]),
        **{name: end.metrics.get(name) for name in MEASURED},
        "replans": end.replans,
        "refused": refused,
        "merges": merges,
        "risky_merges": sum(value is not None and value < RISKY for value in merges),
    }
