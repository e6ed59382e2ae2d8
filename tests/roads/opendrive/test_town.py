from __future__ import annotations

import math
from collections import Counter

import pytest

from tmpud.roads.moves import SHORTEST_MERGE, moves
from tmpud.roads.network import WHOLE, LaneConnection, RoadNetwork
from tmpud.symbols import Action


def way(town: RoadNetwork, start: str, end: str) -> LaneConnection:
    return next(each for each in town.outgoing(start) if each.to_lane == end)


def test_sections_between_which_nothing_changes_are_one_lane(town: RoadNetwork) -> None:
    assert town.edges["1.0.right"] == ("1.0.-2", "1.0.-1")
    assert town.edges["1.1.left"] == ("1.1.2", "1.1.1")
    assert town.parts["1.1.-2"] == "1.0.-2"
    assert town.parts["1.0.2"] == "1.1.2"
    assert town.lanes["1.0.-2"].length == pytest.approx(185.0, abs=0.001)


def test_where_the_number_of_lanes_changes_lanes_lead_on_to_the_next_edge(town: RoadNetwork) -> None:
    assert town.edges["3.1.left"] == ("3.1.3", "3.1.2", "3.1.1")
    assert town.edges["3.0.left"] == ("3.0.2", "3.0.1")
    assert way(town, "3.1.2", "3.0.2").action is Action.FORWARD
    assert town.outgoing("3.1.3") == []


def test_only_lanes_for_cars_that_lead_the_same_way_are_neighbours(town: RoadNetwork) -> None:
    assert town.neighbour("2.0.-2", Action.MERGELEFT) is town.lanes["2.0.-1"]
    assert town.neighbour("2.0.-1", Action.MERGELEFT) is None  # oncoming
    assert town.neighbour("2.0.-2", Action.MERGERIGHT) is None  # for bicycles
    assert town.neighbour("2.0.2", Action.MERGELEFT) is town.lanes["2.0.1"]


def test_marks_of_both_sections_say_where_a_lane_may_be_left(town: RoadNetwork) -> None:
    (first, second) = town.lanes["1.0.-2"].change_left
    assert (*first, second.start) == pytest.approx((0.0, 60.0, 150.0), abs=0.001)
    assert second.end == math.inf
    (first, second) = town.lanes["1.1.2"].change_left  # the same marks, driven past the other way
    assert (*first, second.start) == pytest.approx((0.0, 35.0, 125.0), abs=0.001)
    assert town.lanes["2.0.-2"].change_left == WHOLE


def test_marks_that_may_be_crossed_one_way_go_by_the_numbers_of_lanes(town: RoadNetwork) -> None:
    upward, downward = ("4.0.-2", Action.MERGELEFT), ("4.0.-1", Action.MERGERIGHT)
    assert town.may_change(*upward)
    assert not town.may_change(*downward)
    assert not town.may_change("5.0.-2", Action.MERGELEFT)
    assert town.may_change("5.0.-1", Action.MERGERIGHT)
    assert town.may_change("5.0.2", Action.MERGELEFT)


def test_merges_are_offered_where_the_marks_leave_room_for_them(town: RoadNetwork) -> None:
    found = [
        segment for segment in town.segments_of("1.0.-2") for move in moves(town, segment.id) if move.action.is_merge
    ]
    assert [segment.number for segment in found] == [0]
    assert found[0].middle + SHORTEST_MERGE < 60.0


def test_each_way_over_the_crossing_turns_as_it_bends(town: RoadNetwork) -> None:
    assert way(town, "1.0.-1", "3.0.-1").action is Action.TURNLEFT
    assert way(town, "1.0.-2", "4.0.2").action is Action.TURNRIGHT
    assert way(town, "2.0.2", "1.1.2").action is Action.FORWARD
    assert Counter(each.action for each in town.connections if each.junction == "100") == {
        Action.FORWARD: 8,
        Action.TURNLEFT: 4,
        Action.TURNRIGHT: 4,
    }


def test_speed_limits_are_the_roads_in_metres_per_second(town: RoadNetwork) -> None:
    assert town.lanes["1.0.-1"].speed == pytest.approx(30 * 0.44704)
    assert town.lanes["5.0.-1"].speed == pytest.approx(50 / 3.6)  # the file has none


def test_widths_and_heights_are_the_maps(town: RoadNetwork) -> None:
    assert {lane.width for lane in town.lanes.values()} == {3.5}
    lane = town.lanes["2.0.-1"]
    assert (lane.elevation[0], lane.elevation[-1]) == pytest.approx((0.0, 0.02 * 170), abs=0.001)
    assert town.lanes["2.0.1"].elevation[0] == pytest.approx(0.02 * 170, abs=0.001)


def test_lights_hold_for_the_lanes_that_face_them_and_switch_by_their_controllers(town: RoadNetwork) -> None:
    light = town.signals["100"]
    assert light.lights == ("1", "2", "3", "4")
    for each in town.connections:
        road = each.from_lane.split(".")[0]
        assert (each.signal, each.link) == (("100", light.lights.index(road)) if each.junction == "100" else (None, -1))
    assert [state for _, state in light.phases] == ["ggrr", "yyrr", "rrrr", "rrgg", "rryy", "rrrr"]


def test_a_stop_sign_holds_for_its_lane_and_lets_all_others_go_first(town: RoadNetwork) -> None:
    signed = [each for each in town.connections if each.priority == "s"]
    assert {each.from_lane for each in signed} == {"6.0.-1"}
    for each in signed:
        assert set(each.foes) == set(each.yields_to)
        assert each.foes


def test_of_two_whose_paths_cross_at_most_one_waits(town: RoadNetwork) -> None:
    for index, each in enumerate(town.connections):
        assert set(each.yields_to) <= set(each.foes)
        for foe in each.foes:
            other = town.connections[foe]
            assert index in other.foes
            assert other.junction == each.junction
            assert not (foe in each.yields_to and index in other.yields_to)


def test_turning_left_waits_for_those_who_come_towards_it_and_all_for_the_right(town: RoadNetwork) -> None:
    left, oncoming = way(town, "1.0.-1", "3.0.-1"), way(town, "2.0.2", "1.1.2")
    assert town.index_of(oncoming) in left.yields_to
    west, south = way(town, "1.0.-1", "2.0.-1"), way(town, "4.0.-1", "3.0.-1")
    assert town.index_of(south) in west.yields_to
    assert town.index_of(west) not in south.yields_to


def test_ways_that_keep_apart_are_no_foes(town: RoadNetwork) -> None:
    east, west = way(town, "1.0.-2", "2.0.-2"), way(town, "2.0.2", "1.1.2")
    assert town.index_of(west) not in east.foes


def test_junctions_cover_the_ways_through_them(town: RoadNetwork) -> None:
    junction = town.junctions["100"]
    assert junction.kind == "traffic_light"
    assert (junction.x, junction.y) == pytest.approx((0.0, 0.0), abs=0.1)
    assert max(math.hypot(x, y) for x, y in junction.shape) == pytest.approx(math.hypot(15, 7), abs=0.1)


def test_the_frame_is_opendrives_own(town: RoadNetwork) -> None:
    assert town.frame.offset == (0.0, 0.0)
    assert town.frame.projection.startswith("+proj=tmerc")
    assert town.locate(-100.0, -5.25)[0].id == "1.0.-2"  # right lanes lie south of a road to the east
