"""Estimate how safe a merge is (Algorithm 1), in a scene made by hand: one car beside the ego, a little behind."""

import numpy as np

from tmpud import TMPUD, LaneMotionPlanner, Problem, SafeSetEstimator, Scene, StateMapping, Vehicles, VehicleState

problem = Problem.of("millbrook", "park1e_0", "high4n")
merge = problem.solve().plan[0]
network = problem.network

mapping = StateMapping(network, problem.request, TMPUD)
ego_lane, station = mapping(merge.state)
target_lane = network.segments[merge.next_state.segment].lane
estimator = SafeSetEstimator(TMPUD, LaneMotionPlanner(network, mapping), network)

for behind in (2.0, 20.0):  # [m]
    ego = VehicleState("ego", network.lanes[ego_lane].centre.pose_at(station), ego_lane, speed=5.0)
    place = network.lanes[target_lane].centre.pose_at(station - behind)
    car = VehicleState("car", place, target_lane, speed=5.5)
    scene = Scene(time=0.0, ego=ego, others=Vehicles.of([car]), signals={})
    estimate = estimator.estimate(merge, scene, np.random.default_rng(0))
    print(f"{merge.action}, a car {behind:.0f} m behind: Safe = {estimate.safe:.2f}, worst vehicle {estimate.worst}")
    print("  o_i(t):", " ".join(f"{share:.2f}" for share in estimate.o[0]))
