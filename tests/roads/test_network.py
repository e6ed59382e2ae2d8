from __future__ import annotations

from functools import cache
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.roads import RoadNetwork, load_map
from tmpud.roads.loading import map_file
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.symbols import Action

LANES = st.sampled_from(sorted(load_map("millbrook").lanes))
SEGMENTS = st.sampled_from(sorted(load_map("millbrook").segments))


@cache
def town(segment_length: float = 60.0) -> RoadNetwork:
    return load_map("millbrook", segment_length)


@given(LANES, st.sampled_from([15.0, 60.0, 100.0, float("inf")]))
def test_segments_tile_their_lane_and_are_short_enough(lane: str, longest: float) -> None:
    cut = town(longest).segments_of(lane)
    assert cut[0].start == 0.0
    assert cut[-1].end == pytest.approx(town().lanes[lane].length)
    assert all(before.end == after.start for before, after in pairwise(cut))
    assert all(0 < segment.end - segment.start <= longest + 1e-6 for segment in cut)


@given(LANES)
def test_lanes_of_one_road_are_cut_in_the_same_number_of_parts(lane: str) -> None:
    row = town().edges[town().lanes[lane].edge]
    assert len({len(town().segments_of(other)) for other in row}) == 1


@given(LANES, st.floats(0, 1))
def test_a_station_lies_on_the_segment_that_is_found_for_it(lane: str, share: float) -> None:
    station = share * town().lanes[lane].length
    found = town().segment_at(lane, station)
    assert found.start <= station <= found.end + 1e-9


@given(SEGMENTS)
def test_ahead_and_behind_left_and_right_undo_each_other(segment: str) -> None:
    network = town()
    if ahead := network.ahead(segment):
        assert network.behind(ahead.id) == network.segments[segment]
    if left := network.beside(segment, Action.MERGELEFT):
        assert network.beside(left.id, Action.MERGERIGHT) == network.segments[segment]


@given(LANES, st.floats(0.05, 0.95), st.floats(-1.7, 1.7))
def test_a_point_on_a_lane_is_located_there(lane: str, share: float, offset: float) -> None:
    line = town().lanes[lane].centre
    pose = line.pose_at(share * line.length, offset)
    found, _, side = town().locate(pose.x, pose.y)
    assert found.id == lane
    assert side == pytest.approx(offset, abs=0.2)


def test_connections_are_found_from_both_ends_and_by_their_internal_lanes() -> None:
    network = town()
    for index, connection in enumerate(network.connections):
        assert connection in network.outgoing(connection.from_lane)
        assert connection in network.incoming(connection.to_lane)
        assert all(network.internal[lane] == index for lane in connection.internal_lanes)


def test_one_segment_per_lane_where_the_length_has_no_limit() -> None:
    network = read_sumo_net(map_file("millbrook"), segment_length=float("inf"))
    assert len(network.segments) == len(network.lanes)
