"""Merges with what every predictor said of them and what came of them: from drives in a town, and local."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Generator, Iterable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from tmpud.errors import NoPlanError, SimulatorError
from tmpud.events import Event, Executed, Finished, Judged
from tmpud.execution.deliberation import Deliberation
from tmpud.experiments.calibration.scores import PRESETS, MergePanel, SeenMerge, neighbours_of
from tmpud.experiments.running.tasks import SIM_CRASH, Json, Task
from tmpud.experiments.trials.full import FullTrials, Town
from tmpud.experiments.trials.table1 import TRAFFIC
from tmpud.experiments.worlds.merges import CONDITIONS, ROADS, LocalArea, local_merges, local_network
from tmpud.judging.rules import JudgingRules, Kind
from tmpud.presets import TMPUD
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.runner import drive
from tmpud.scene import Outcome
from tmpud.symbols import TaskPlan

VIAS = 4  # random places on the way, so that a drive merges several times
WATCHED = JudgingRules().merge_window  # [s]
MOST_EXTRA = 2  # actions by which a merge that was not planned may lengthen the plan


def town_tasks(drives: int, first_seed: int, map_: str) -> list[Task]:
    """Return drives on random missions, so many for each density of Table I."""
    return [
        Task(
            key=f"{map_}/{vehicles}/{seed}",
            work="merge scenes",
            shared={
                "map": map_,
                "start": "random",
                "goal": "random",
                "via": ["random"] * VIAS,
                "algorithm": "no-com",
                "traffic": vehicles,
                "seed": seed,
            },
            arguments={"presets": list(PRESETS)},
        )
        for vehicles in TRAFFIC.values()
        for seed in range(first_seed, first_seed + drives)
    ]


def local_tasks(merges: int, first_seed: int) -> list[Task]:
    """Return runs of ROADS forced merges each, so many merges for each of the paper's road conditions."""
    return [
        Task(
            key=f"local/{condition}/{seed}",
            work="local merge scenes",
            shared={},
            arguments={"condition": condition, "seed": seed, "merges": ROADS, "presets": list(PRESETS)},
        )
        for condition in CONDITIONS
        for seed in range(first_seed, first_seed + math.ceil(merges / ROADS))
    ]


class MergeScenes(FullTrials):
    """One eager drive in a town; its result holds a row for each merge that was begun."""

    def run(self, prepared: Town, arguments: Json) -> Json:
        """Drive the town's mission; the rows are as ``merge_rows`` says."""
        mission, town, _ = prepared
        panels: list[MergePanel] = []

        def panel(_: Any, motion: Any, network: Any) -> MergePanel:
            panels.append(MergePanel(arguments["presets"], motion, network, partial(load_map, mission.map)))
            return panels[-1]

        events = drive(mission, simulator=lambda *_: town, frames=False, communicate=Eager(), estimator=panel)
        log = list(events)
        end = next(event for event in log if isinstance(event, Finished))
        if end.status == SIM_CRASH:
            raise SimulatorError(end.message)
        return {"status": end.status, "merges": merge_rows(panels[0].seen, log)}


class LocalMergeScenes:
    """Some forced merges side by side; a row for each as a drive's."""

    isolated = True  # libsumo holds one simulation per process

    def prepare(self, shared: Json) -> None:
        """Nothing is shared."""

    def run(self, prepared: None, arguments: Json) -> Json:  # noqa: ARG002
        """Run all merges of the task side by side."""
        count, seed = arguments["merges"], arguments["seed"]
        area, rng = LocalArea(TMPUD), np.random.default_rng(seed)
        panel = MergePanel(arguments["presets"], area.motion, area.network, _local_network)
        rows = []
        for merge in local_merges(CONDITIONS[arguments["condition"]], count, seed, roads=count):
            panel.estimate(area.transition(merge.scene), merge.scene, rng)
            rows.append(_row(panel.seen[-1], merge.outcome))
        return {"status": "SUCCESS", "merges": rows}


def _local_network(segment_length: float) -> RoadNetwork:
    return local_network(replace(TMPUD, segment_length=segment_length))


class Eager:
    """No-com that also merges where its plan does not, once in WATCHED seconds, and has each merge estimated first.

    Estimates change nothing: what was planned is driven. A drive thus merges three times as often as its plan asks for.
    """

    def __init__(self) -> None:
        self._last = -math.inf  # [s] when it merged

    def __call__(self, plan: TaskPlan, mind: Deliberation) -> Generator[Event, None, TaskPlan]:
        """Do what lines 5 to 7 of Algorithm 2 do."""
        step = plan[0]
        if step.action.is_merge:
            if math.isfinite(mind.world.path_length(step)):
                self._last = mind.world.time
                yield mind.estimated(step, mind.world.estimate(step))
            return plan
        due = mind.world.time - self._last >= WATCHED
        return _by_way_of_a_merge(plan, mind) if due else plan


def _by_way_of_a_merge(plan: TaskPlan, mind: Deliberation) -> TaskPlan:
    """Return a plan that begins with a merge, or the plan itself where none can be driven without a long way round."""
    for way in mind.domain.successors(plan[0].state):
        if way.action.is_merge and math.isfinite(mind.world.path_length(way)):
            with contextlib.suppress(NoPlanError):
                found = (way, *mind.plan(way.next_state))
                if len(found) <= len(plan) + MOST_EXTRA:
                    return found
    return plan


def merge_rows(seen: Iterable[SeenMerge], log: Sequence[Event]) -> list[dict[str, Any]]:
    """Return a row for each merge that was begun and watched to its end.

    A merge answers for what the judge lays to merges until the next one begins, at most 8 s. One after which the
    drive ended earlier, but for a collision of its own, is left out: nobody knows what would have come of it.
    """
    undone = {(event.step, event.time) for event in log if isinstance(event, Executed) and _undone(event)}
    begun = [merge for merge in seen if (merge.step, merge.scene.time) not in undone]
    verdicts = [event for event in log if isinstance(event, Judged) and _is_unsafe_merge(event)]
    rows = []
    for merge, following in zip(begun, [*begun[1:], None], strict=True):
        start = merge.scene.time
        until = min(start + WATCHED, following.scene.time if following else math.inf)
        found = [event for event in verdicts if start < event.time <= until + 1e-9]
        outcome = _outcome({event.kind for event in found})
        if log[-1].time - start >= WATCHED or outcome == "collide":
            rows.append(_row(merge, outcome))
    return rows


def _row(merge: SeenMerge, outcome: str) -> dict[str, Any]:
    return {
        "time": merge.scene.time,
        "speed": round(merge.scene.ego.speed, 3),
        "neighbours": neighbours_of(merge.scene),
        "action": merge.step.action.value,
        "to": merge.step.next_state.segment,
        "scores": dict(merge.scores),
        "unsafe": outcome != "merge",
        "outcome": outcome,
    }


def _outcome(kinds: set[str]) -> str:
    return "collide" if Kind.COLLISION in kinds else "stop" if kinds else "merge"


def _undone(event: Executed) -> bool:
    return event.outcome == Outcome.INFEASIBLE


def _is_unsafe_merge(event: Judged) -> bool:
    return event.kind == Kind.FORCED_STOP or (event.kind == Kind.COLLISION and event.rule == "merge")
