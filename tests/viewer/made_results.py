"""A problem, its plan, and the estimate of its first merge with one car a little behind."""

from __future__ import annotations

import numpy as np

from tmpud import TMPUD, LaneMotionPlanner, Problem, SafeSetEstimator, Scene, StateMapping, Vehicles, VehicleState
from tmpud.safety.estimator import SafetyEstimate

PROBLEM = Problem.of("millbrook", "park1e_0", "high4n")
REPORT = PROBLEM.solve()


def estimate(name: str = "car", behind: float = 2.0) -> SafetyEstimate:
    network, merge = PROBLEM.network, REPORT.plan[0]
    mapping = StateMapping(network, PROBLEM.request, TMPUD)
    lane, station = mapping(merge.state)
    target = network.segments[merge.next_state.segment].lane
    ego = VehicleState("ego", network.lanes[lane].centre.pose_at(station), lane, speed=5.0)
    car = VehicleState(name, network.lanes[target].centre.pose_at(station - behind), target, speed=5.5)
    scene = Scene(time=0.0, ego=ego, others=Vehicles.of([car]), signals={})
    estimator = SafeSetEstimator(TMPUD, LaneMotionPlanner(network, mapping), network)
    return estimator.estimate(merge, scene, np.random.default_rng(0))
