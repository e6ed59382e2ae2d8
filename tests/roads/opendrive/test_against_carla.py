"""What is read, against what CARLA's own client says of the same map."""

from __future__ import annotations

import math
from collections import defaultdict
from itertools import pairwise

from tests.roads.opendrive.conftest import Case
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action

SIDES = {"left": Action.MERGELEFT, "right": Action.MERGERIGHT}


def parts_of(network: RoadNetwork) -> dict[str, list[str]]:
    """Return the parts of each lane, in driving order."""
    found: dict[str, list[str]] = defaultdict(list)
    for part, lane in network.parts.items():
        found[lane].append(part)
    return found


def test_every_driving_lane_of_the_topology_is_one_lane_or_a_part_of_one(case: Case) -> None:
    outside = {key for pair in case.oracle["topology"] for key in pair} - case.oracle["junctions"].keys()
    assert case.network.parts.keys() == outside
    assert set(case.network.parts.values()) == case.network.lanes.keys()


def test_the_ways_from_lane_to_lane_are_those_of_the_topology(case: Case) -> None:
    inside, onward = case.oracle["junctions"], defaultdict(set)
    for here, there in case.oracle["topology"]:
        if here != there:  # CARLA names a left lane without an exit as its own successor
            onward[here].add(there)
    expected = set()
    for start in case.network.parts:
        work, seen = list(onward[start]), set()
        while work:
            here = work.pop()
            if here not in inside:
                expected.add((start, here))
            elif here not in seen:
                seen.add(here)
                work += onward[here]
    parts = parts_of(case.network)
    joined = {pair for row in parts.values() for pair in pairwise(row)}
    ways = {(parts[way.from_lane][-1], parts[way.to_lane][0]) for way in case.network.connections}
    assert joined | ways == expected
    assert not joined & ways


def test_the_lanes_through_a_junction_belong_to_the_connections_of_that_junction(case: Case) -> None:
    for way in case.network.connections:
        for key in way.internal_lanes:
            assert str(case.oracle["junctions"][key]) == way.junction
    assert case.network.internal.keys() <= case.oracle["junctions"].keys()


def test_lanes_run_through_carlas_waypoints_in_driving_order_at_their_height(case: Case) -> None:
    stations: dict[str, list[float]] = defaultdict(list)
    for waypoint in case.oracle["waypoints"]:
        if (name := case.network.parts.get(waypoint["lane"])) is None:
            continue
        lane, (x, y, z) = case.network.lanes[name], waypoint["at"]
        station, offset = lane.centre.project(x, -y)
        assert abs(offset) < 0.03
        i = min(max(sum(s <= station for s in lane.centre.stations) - 1, 0), len(lane.elevation) - 2)
        s0, s1 = lane.centre.stations[i : i + 2]
        height = lane.elevation[i] + (station - s0) / (s1 - s0) * (lane.elevation[i + 1] - lane.elevation[i])
        assert abs(height - z) < 0.05
        stations[name].append(station)
    for name, found in stations.items():
        assert len(found) >= case.network.lanes[name].length - 2 * len(parts_of(case.network)[name]) - 1
        assert max(found) <= case.network.lanes[name].length


def test_neighbours_are_carlas_where_it_lets_one_change_lanes_and_nowhere_else(case: Case) -> None:
    compared = 0
    for waypoint in case.oracle["waypoints"]:
        if (name := case.network.parts.get(waypoint["lane"])) is None:
            continue
        lane = case.network.lanes[name]
        station = lane.centre.project(waypoint["at"][0], -waypoint["at"][1])[0]
        for side, action in SIDES.items():
            allowed = lane.change_left if side == "left" else lane.change_right
            expected = waypoint["beside"].get(side, "")
            if expected == "one-way" or any(abs(station - end) < 0.1 for stretch in allowed for end in stretch):
                continue
            there = case.network.neighbour(name, action)
            open_here = there is not None and any(start <= station <= end for start, end in allowed)
            if expected in case.network.parts:
                assert open_here
                assert there is not None
                assert case.network.parts[expected] == there.id
                compared += 1
            else:
                assert not open_here
    assert compared or case.network.name != "crossroads"


def test_each_light_holds_for_the_ways_that_carla_says(case: Case) -> None:
    expected = {
        (f"{road}.", lane, name)
        for name, kind, road, lanes in case.oracle["marks"]
        if kind == "1000001"
        for pair in lanes
        for lane in range(min(pair), max(pair) + 1)
        if lane
    }
    found = {
        (key.split(".")[0] + ".", int(key.split(".")[2]), case.network.signals[way.signal].lights[way.link])
        for way in case.network.connections
        if way.signal is not None
        for key in way.internal_lanes
    }
    assert found == expected


def test_paths_join_lane_to_lane_without_a_gap_or_a_kink(case: Case) -> None:
    for way in case.network.connections:
        start, end = case.network.lanes[way.from_lane].centre, case.network.lanes[way.to_lane].centre
        assert math.dist(way.path.points[0], start.points[-1]) < 0.01
        assert math.dist(way.path.points[-1], end.points[0]) < 0.11
        line = [start.pose_at(start.length), *map(way.path.pose_at, way.path.stations[:-1]), end.pose_at(0.0)]
        for before, after in pairwise(line):
            assert math.cos(after.heading - before.heading) > math.cos(math.radians(30))
