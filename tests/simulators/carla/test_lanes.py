import math

import pytest

from tmpud.geometry import Pose, wrap_angle
from tmpud.roads import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.simulators.carla.lanes import LaneFinder


@pytest.fixture(scope="module")
def town() -> RoadNetwork:
    return load_map("millbrook")


@pytest.fixture(scope="module")
def finder(town: RoadNetwork) -> LaneFinder:
    return LaneFinder(town)


def test_on_each_centre_line_is_that_lane_and_against_it_is_not(town: RoadNetwork, finder: LaneFinder) -> None:
    for lane in town.lanes.values():
        for share in (0.1, 0.5, 0.9):
            x, y, heading = lane.centre.pose_at(share * lane.length)
            assert finder.lane(Pose(x, y, heading), lane.level) == lane.id
            assert finder.lane(Pose(x, y, wrap_angle(heading + math.pi)), lane.level) != lane.id


def test_within_a_junction_the_lane_is_the_expected_one_of_those_as_near(town: RoadNetwork, finder: LaneFinder) -> None:
    for way in town.connections:
        if way.path.length > 1.0:
            pose = way.path.pose_at(way.path.length / 2)
            z = town.lanes[way.from_lane].elevation[-1]
            assert finder.lane(pose, z, {way.internal_lanes[0]}) == way.internal_lanes[0]


def test_off_the_road_and_on_a_bridge_above_it_there_is_no_lane(town: RoadNetwork, finder: LaneFinder) -> None:
    lane = town.lanes["park1e_0"]
    pose = lane.centre.pose_at(30.0)
    assert finder.lane(pose, lane.level + 6.0) == ""
    assert finder.lane(Pose(1e6, 1e6, 0.0), 0.0) == ""
