"""Forced merges in the local simulation: the scene at the decision, and how it ended.

Planner, tracker, dynamics and judge are those of the full simulation. The ego keeps its lane until the decision, then
merges whatever is there; it follows its origin lane's leader until its centre crosses the line.
"""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tmpud.execution.abstract import COLLIDE, MERGE, STOP
from tmpud.judging.judge import Judge
from tmpud.judging.rules import JudgingRules, Kind, Verdict
from tmpud.motion.mapping import StateMapping
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.presets import TMPUD, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.safety.estimator import SafeSetEstimator
from tmpud.scene import Control, Scene
from tmpud.simulators.conventions import DT
from tmpud.simulators.local import Condition, LocalRoads, PlacementLaw
from tmpud.simulators.local_roads import lane_name, write_net
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition

CONDITIONS = {
    "low density, low acceleration": Condition(neighbours=1, acceleration=0.5),
    "low density, high acceleration": Condition(neighbours=1, acceleration=1.0),
    "high density, low acceleration": Condition(neighbours=3, acceleration=0.5),
    "high density, high acceleration": Condition(neighbours=3, acceleration=1.0),
}
ROADS = 100  # merges that run side by side
CHUNKS = 100_003  # more than any series of merges has
WATCHED = JudgingRules().merge_window  # [s] from the decision on


@dataclass(frozen=True, slots=True, eq=False)
class LocalMerge:
    """One forced merge."""

    scene: Scene  # at the decision
    outcome: str  # merge, collide or stop
    verdicts: tuple[Verdict, ...]  # all that the judge said


class LocalArea:
    """The two-lane road as one preset sees it: its network, its motion planner and its estimator."""

    def __init__(self, preset: Preset) -> None:
        self.preset = preset
        self.network = local_network(preset)
        start, goal = (Place(name, (self.network.segments_of(lane_name(0, 0))[0].id,)) for name in ("start", "goal"))
        self.mapping = StateMapping(self.network, ServiceRequest(start, (goal,)), preset)
        self.motion = LaneMotionPlanner(self.network, self.mapping)
        self.estimator = SafeSetEstimator(preset, self.motion, self.network)

    def transition(self, scene: Scene, *, merge: bool = True) -> Transition:
        """Return the merge to the other lane from where the ego is, or the step that keeps its lane."""
        lane = self.network.lanes[scene.ego.lane]
        here = self.network.segment_at(lane.id, scene.ego.pose.x)
        action = (Action.MERGERIGHT if lane.index else Action.MERGELEFT) if merge else Action.FORWARD
        there = self.network.merge_target(here.id, action) if merge else self.network.segments_of(lane.id)[-1]
        if there is None:
            raise ValueError(f"the ego at {scene.ego.pose} is not where it can merge")
        return Transition(State(here.id, 0), action, State(there.id, 0))

    def safe(self, scene: Scene, rng: np.random.Generator) -> float:
        """Return Safe of the merge in a scene (Algorithm 1)."""
        return self.estimator.estimate(self.transition(scene), scene, rng).safe


def local_network(preset: Preset) -> RoadNetwork:
    with tempfile.TemporaryDirectory(prefix="tmpud-local-") as folder:
        return read_sumo_net(write_net(Path(folder), 1), segment_length=preset.segment_length)


def local_merges(condition: Condition, count: int, seed: int, *, roads: int = ROADS) -> Iterator[LocalMerge]:
    """Yield ``count`` forced merges in order; the first of a longer series are those of a shorter one."""
    chunks = (local_chunk(condition, seed, chunk, roads=roads) for chunk in itertools.count())
    yield from itertools.islice(itertools.chain.from_iterable(chunks), count)


def local_chunk(condition: Condition, seed: int, chunk: int, *, roads: int) -> Iterator[LocalMerge]:
    """Yield the merges of one fresh simulation, one on each road.

    A run with a collision before the decision is left out.
    """
    law, area = PlacementLaw(), LocalArea(TMPUD)
    with LocalRoads(condition, roads, CHUNKS * seed + chunk, law) as town:
        runs = {road: _Run(area, scene) for road, scene in town.scenes.items()}
        active = dict(runs)
        _drive(town, active, round(law.settling / DT))
        valid = list(active.values())
        for run in valid:
            run.decide()
        _drive(town, active, round(WATCHED / DT))
    for run in valid:
        yield LocalMerge(run.decision, _outcome(run.judge.verdicts), run.judge.verdicts)


class _Run:
    """One ego: its motion planner and its judge."""

    def __init__(self, area: LocalArea, scene: Scene) -> None:
        self._area = area
        self._motion = LaneMotionPlanner(area.network, area.mapping)
        self.judge = Judge(area.network)
        self.scene = self.decision = scene
        self._motion.begin(area.transition(scene, merge=False), scene, ())

    def decide(self) -> None:
        self.decision = self.scene
        merge = self._area.transition(self.scene)
        origin, target = (self._area.network.segments[state.segment].lane for state in (merge.state, merge.next_state))
        self._motion.begin(merge, self.scene, ())
        self.judge.merge_began(self.scene, origin, target)

    def control(self) -> Control:
        return self._motion.control(self.scene)

    def observe(self, scene: Scene) -> None:
        self.scene = scene
        self.judge.observe(scene)


def _drive(town: LocalRoads, active: dict[int, _Run], steps: int) -> None:
    """Let some steps go by; runs that end in a collision leave ``active``."""
    for _ in range(steps):
        town.step({road: run.control() for road, run in active.items()})
        for road, scene in town.scenes.items():
            active[road].observe(scene)
            if active[road].judge.collisions:
                town.end(road)
                del active[road]


def _outcome(verdicts: tuple[Verdict, ...]) -> str:
    kinds = [verdict.kind for verdict in verdicts]
    return COLLIDE if Kind.COLLISION in kinds else STOP if Kind.FORCED_STOP in kinds else MERGE
