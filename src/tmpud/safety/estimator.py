"""Algorithm 1, safety estimation: how much freedom an action leaves the controller next to every vehicle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tmpud.dynamics import EGO, VehicleLimits
from tmpud.errors import InfeasibleMotionError, InvalidStateError
from tmpud.presets import Preset
from tmpud.protocols import MotionPlanner
from tmpud.roads.network import RoadNetwork
from tmpud.safety import control_set, neighbours
from tmpud.safety.share import exact_share, sampled_share
from tmpud.scene import FloatArray, Scene, Vehicles
from tmpud.showing import ShownAsSvg
from tmpud.symbols import Transition
from tmpud.trajectory import Prediction, Trajectory, predict

TOO_LARGE = 1e50  # squares of squares of less are still numbers


@dataclass(frozen=True, slots=True, eq=False)
class SafetyEstimate(ShownAsSvg):
    """Safe(<s, a, s'>) and what it was made of: N vehicles looked at, T instants."""

    safe: float  # min_i o_i*, in [0, 1]; 1.0 without vehicles
    worst: str | None  # the vehicle that sets it; None where none was looked at
    min_t: float  # the least o_i(t) of all at the ego speed that counts; 1.0 without vehicles
    ids: tuple[str, ...]  # (N,)
    o: FloatArray  # (N, T) o_i(t)
    o_star: FloatArray  # (N,) o_i*
    trajectory: Trajectory  # xi^E
    times: FloatArray  # (T,) [s] relative to the scene
    others: Vehicles | None = None  # the N vehicles; None where Safe was drawn and not estimated ...
    sets: control_set.SafeSets | None = None  # ... and their U_i^S(t)


class SafeSetEstimator:
    """The safety estimator of the paper, its open points settled by a preset."""

    def __init__(
        self, preset: Preset, motion: MotionPlanner, network: RoadNetwork, limits: VehicleLimits = EGO
    ) -> None:
        self._preset, self._motion, self._network, self._limits = preset, motion, network, limits
        self._controls = control_set.controls(preset)

    def estimate(self, transition: Transition, scene: Scene, rng: np.random.Generator) -> SafetyEstimate:
        """Return Safe of an action begun in a scene; the worst of ``ego_speeds`` counts.

        The generator is only drawn from where the preset samples. Raises InvalidStateError for a scene or a trajectory
        with a value that is not finite or too large, and what the motion planner raises where it cannot be driven.
        """
        _check(f"the scene at {scene.time} s", np.array(scene.ego.body), *scene.others.columns)
        # Line 1: x is where the ego is, x' = f(s') ends the action; they set the horizon
        times = self._instants(transition)
        # Line 2
        trajectories = [
            self._motion.trajectory(transition, scene, times, speed) for speed in self._preset.ego_speeds or (None,)
        ]
        for ego in trajectories:
            _check(f"the trajectory of {transition}", ego.poses, ego.speeds)
        others = self._surrounding(transition, scene, trajectories[0])
        # Line 3
        predicted = predict(others, times)
        return min((self._along(ego, others, predicted, rng) for ego in trajectories), key=lambda e: (e.safe, e.min_t))

    def _along(
        self, ego: Trajectory, others: Vehicles, predicted: Prediction, rng: np.random.Generator
    ) -> SafetyEstimate:
        # Lines 4 and 8: for each vehicle V_i, all in one array
        # Line 5
        index = control_set.safety_index(ego, others, predicted, self._preset)
        # Line 6
        sets, o = self._share(index, ego, rng)
        # Line 7
        o_star = aggregate(o, self._preset)
        # Line 9
        return _least(o, o_star, ego, others, sets)

    def _instants(self, transition: Transition) -> FloatArray:
        """Return t = t_1 + omega i over the horizon (Alg. 1, line 5), relative to t_1."""
        horizon = self._preset.horizon
        if horizon is None:
            length = self._motion.path_length(transition)
            if not math.isfinite(length):
                raise InfeasibleMotionError(f"{transition} cannot be driven, so it has no horizon")
            horizon = length / (self._preset.ego_speeds or (self._limits.max_speed,))[0]
        count = math.floor(horizon / self._preset.interval + 1e-9) + 1
        return np.arange(count, dtype=np.float64) * self._preset.interval

    def _surrounding(self, transition: Transition, scene: Scene, ego: Trajectory) -> Vehicles:
        near = neighbours.perceived(self._preset, self._network, transition, scene)
        if transition.action.is_merge or self._preset.lane_keeping == "all vehicles":
            return near
        lanes = self._motion.lanes(transition)
        near = neighbours.conflicting(near, scene.ego.lane, lanes, self._network)
        return neighbours.crossing(near, ego, self._limits.width)

    def _share(
        self, index: control_set.SafetyIndex, ego: Trajectory, rng: np.random.Generator
    ) -> tuple[control_set.SafeSets, FloatArray]:
        """Return U_i^S(t) and o_i(t) (N, T): 1 where the gate is shut, else the share of safe controls."""
        o = np.ones_like(index.phi)
        cut = control_set.in_use(index, ego, self._preset)
        plane = control_set.half_plane(index, ego, self._preset, self._limits.wheelbase).at(cut)
        if self._preset.share == "sampled":
            o[cut] = sampled_share(plane, self._controls, self._preset.samples, rng)
        else:
            o[cut] = exact_share(plane, self._controls)
        return control_set.SafeSets(cut, plane, self._controls), o


def aggregate(o: FloatArray, preset: Preset) -> FloatArray:
    """Return o_i* (N,) of o_i(t) (N, T): the paper's (max + mean)/2, or (min + mean)/2."""
    extreme = o.max(axis=1) if preset.aggregate == "max+mean" else o.min(axis=1)
    return np.asarray((extreme + o.mean(axis=1)) / 2)


def _least(
    o: FloatArray, o_star: FloatArray, ego: Trajectory, others: Vehicles, sets: control_set.SafeSets
) -> SafetyEstimate:
    """Return min_i o_i* with its vehicle (Alg. 1, line 9)."""
    ids = others.ids
    if not ids:
        return SafetyEstimate(1.0, None, 1.0, ids, o, o_star, ego, ego.times, others, sets)
    worst = int(o_star.argmin())
    return SafetyEstimate(
        float(o_star[worst]), ids[worst], float(o.min()), ids, o, o_star, ego, ego.times, others, sets
    )


def _check(what: str, *values: FloatArray) -> None:
    if not all((np.abs(array) < TOO_LARGE).all() for array in values):
        raise InvalidStateError(f"{what} holds a value that is not finite or not below {TOO_LARGE:g}")
