"""Trials in abstract simulation: Algorithm 2 and its baselines in worlds drawn from the learned models."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from tmpud.errors import NoPlanError
from tmpud.events import Estimated, Event, Executed, Planned
from tmpud.execution.abstract import AbstractWorld, JointSample
from tmpud.execution.baselines import communication
from tmpud.execution.deliberation import Deliberation
from tmpud.execution.tmpud import Communicate, run_tmpud
from tmpud.experiments.running.tasks import Json
from tmpud.experiments.trials.plan_memory import PlanMemory
from tmpud.experiments.worlds.models import joint_sample, read_world
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import Preset, preset_named
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import request as service_request
from tmpud.runner import STATUS
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Outcome
from tmpud.symbols import Action, LazyCost, ServiceRequest, State, TaskPlan, Transition
from tmpud.task.domain import Domain
from tmpud.task.search_planner import SearchPlanner


@dataclass(frozen=True, slots=True)
class Way:
    """One mission's request, the lengths of its transitions, and the plans that were made for it."""

    request: ServiceRequest
    domain: Domain
    length: LazyCost
    planner: PlanMemory

    def path_length(self, transition: Transition) -> float:
        return self.length[transition]


class Ground(NamedTuple):
    """What the trials of one experiment share."""

    ways: tuple[Way, ...]  # one per mission
    samples: dict[str, JointSample]  # of each road condition


class AbstractTrials:
    """Work: some trials of one algorithm under one road condition; missions take turns."""

    isolated = False

    def prepare(self, shared: Json) -> Ground:
        """Return map, missions and learned model."""
        preset = preset_named(shared["preset"])
        network = load_map(shared["map"], preset.segment_length)
        world = read_world(shared["world"])
        ways = tuple(_way(network, preset, route, seed) for seed, route in enumerate(shared["routes"], shared["seed"]))
        samples = {name: joint_sample(world, name, preset) for name in world["conditions"]}
        return Ground(ways, samples)

    def run(self, prepared: Ground, arguments: Json) -> Json:
        """Return how each trial ended."""
        communicate = communication(arguments["algorithm"], arguments["beta"])
        sample = prepared.samples[arguments["condition"]]
        for way in prepared.ways:
            way.planner.begin()
        trials = range(arguments["first"], arguments["first"] + arguments["count"])
        ends = []
        for trial in trials:
            way = prepared.ways[trial % len(prepared.ways)]
            world = AbstractWorld(way.length.__getitem__, sample, f"{arguments['draws']}/{trial}")
            ends.append((_driven(way, world, communicate), world))
        made, proved, mismatches = (
            sum(column) for column in zip(*(way.planner.counts() for way in prepared.ways), strict=True)
        )
        return {
            "status": [status for status, _ in ends],
            "distance": [round(world.distance, 3) for _, world in ends],
            "collisions": [world.collisions for _, world in ends],
            "stops": [world.stops for _, world in ends],
            "plans": {"made": made, "proved": proved, "mismatches": mismatches},
        }


class _Silent(Deliberation):
    """A mind of whose drive nobody reads: of an abstract trial only its end is kept."""

    def planned(self, plan: TaskPlan, reason: str) -> Planned:  # noqa: ARG002
        return _A_PLAN

    def estimated(self, step: Transition, estimate: SafetyEstimate) -> Estimated:  # noqa: ARG002
        return _AN_ESTIMATE

    def executed(self, step: Transition, outcome: Outcome, estimated: bool) -> Executed:  # noqa: ARG002
        return _AN_ACTION


_NOWHERE = Transition(State("", 0), Action.FORWARD, State("", 0))
_A_PLAN = Planned(0.0, 0, (), (), (), (), "")
_AN_ESTIMATE = Estimated(0.0, _NOWHERE, 1.0, None, 1.0, (), (), ())
_AN_ACTION = Executed(0.0, _NOWHERE, Outcome.DONE.value, True, 0.0)


def _way(network: RoadNetwork, preset: Preset, route: Sequence[str], seed: int) -> Way:
    start, goal = route
    request = service_request(network, start, (goal,), (), seed)
    paths = PathPlanner(network, StateMapping(network, request, preset, seed))
    length = LazyCost(paths.path_length)
    return Way(request, Domain(network, request), length, PlanMemory(SearchPlanner(network, preset), length))


def _driven(way: Way, world: AbstractWorld, communicate: Communicate) -> str:
    """Run one trial and return its status."""
    mind = _Silent(way.request, way.domain, way.planner, way, world)
    try:
        return STATUS[_last(run_tmpud(way.domain.start_state(), mind, communicate))]
    except NoPlanError:
        return "NO_PLAN"


def _last(run: Generator[Event, Any, Outcome]) -> Outcome:
    """Return how a run ends; its events are of no interest."""
    while True:
        try:
            next(run)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
