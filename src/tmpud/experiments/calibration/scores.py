"""All predictors on the same merge scene: Safe by several presets, beside gap, time to collision and RSS distance."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmpud.errors import InfeasibleMotionError, RequestError
from tmpud.motion.mapping import StateMapping
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.presets import Preset, preset_named
from tmpud.protocols import MotionPlanner
from tmpud.roads.network import RoadNetwork
from tmpud.safety.estimator import SafeSetEstimator, SafetyEstimate
from tmpud.safety.gaps import merge_gaps
from tmpud.scene import Scene
from tmpud.simulators.local import PlacementLaw
from tmpud.symbols import Place, ServiceRequest, State, Transition

PRESETS = ("tmpud", "tmpud:aggregate=max+mean", "paper", "released")
LEAST = "min o"  # of the first preset: the least share of safe controls at any instant
BASELINES = ("gap", "time to collision", "RSS ratio")

REACH = PlacementLaw().reach  # [m] a neighbour is within so much before or behind the ego, as the worlds were learned
BESIDE = 4.8  # [m] across: one and a half lanes
SAME_WAY = math.radians(45.0)

Scores = Mapping[str, float | None]  # None: nothing is in the way, safer than any number (JSON has no infinity)
Networks = Callable[[float], RoadNetwork]  # the map cut into segments of at most this length [m]


@dataclass(frozen=True, slots=True, eq=False)
class SeenMerge:
    """A merge on the point of being begun."""

    scene: Scene
    step: Transition
    scores: Scores


class MergePanel:
    """Asks every predictor about the same merge; to the world it is one safety estimator, that of its first preset.

    A preset that cuts lanes otherwise than the drive does sees the merge on its own network, as in a drive of its own.
    """

    def __init__(self, presets: Sequence[str], motion: MotionPlanner, network: RoadNetwork, networks: Networks) -> None:
        """``presets`` name them as ``preset_named`` reads them; raises RequestError where there is none."""
        if not presets:
            raise RequestError("no preset to score merges by")
        self._network = network
        self._views = {text: _view(preset_named(text), motion, network, networks) for text in presets}
        self.seen: list[SeenMerge] = []

    def estimate(self, transition: Transition, scene: Scene, rng: np.random.Generator) -> SafetyEstimate:
        """Return the first preset's estimate of a merge, and keep in ``seen`` what all predictors say."""
        estimates = {
            text: estimator.estimate(self._on(network, transition, scene), scene, rng)
            for text, (estimator, network) in self._views.items()
        }
        first = next(iter(estimates.values()))
        gaps = merge_gaps(scene, transition, self._network)
        scores = {text: estimate.safe for text, estimate in estimates.items()}
        scores |= {LEAST: first.min_t, **dict(zip(BASELINES, gaps, strict=True))}
        finite = {name: score if math.isfinite(score) else None for name, score in scores.items()}
        self.seen.append(SeenMerge(scene, transition, finite))
        return first

    def _on(self, network: RoadNetwork, step: Transition, scene: Scene) -> Transition:
        """Return the same merge between the segments of a network that may be cut otherwise."""
        if network is self._network:
            return step
        lane = network.lanes[self._network.segments[step.state.segment].lane]
        here = network.segment_at(lane.id, lane.centre.project(scene.ego.pose.x, scene.ego.pose.y)[0])
        there = network.merge_target(here.id, step.action)
        if there is None:
            raise InfeasibleMotionError(f"{step.action} is not offered on {here.id}")
        return Transition(State(here.id, step.state.leg), step.action, State(there.id, step.next_state.leg))


def _view(
    preset: Preset, motion: MotionPlanner, network: RoadNetwork, networks: Networks
) -> tuple[SafeSetEstimator, RoadNetwork]:
    """Return a preset's estimator and the network it sees."""
    if preset.segment_length == network.segment_length:
        return SafeSetEstimator(preset, motion, network), network
    own = networks(preset.segment_length)
    anywhere = Place("anywhere", (next(iter(own.segments)),))
    mapping = StateMapping(own, ServiceRequest(anywhere, (anywhere,)), preset)
    return SafeSetEstimator(preset, LaneMotionPlanner(own, mapping), own), own


def neighbours_of(scene: Scene) -> int:
    """Return how many vehicles surround the ego in the area in which the worlds were learned."""
    ego, others = scene.ego.pose, scene.others
    dx, dy = others.x - ego.x, others.y - ego.y
    along = dx * math.cos(ego.heading) + dy * math.sin(ego.heading)
    across = dy * math.cos(ego.heading) - dx * math.sin(ego.heading)
    turned = np.abs(np.angle(np.exp(1j * (others.heading - ego.heading))))
    return int(np.sum((np.abs(along) <= REACH) & (np.abs(across) <= BESIDE) & (turned <= SAME_WAY)))
