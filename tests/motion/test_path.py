import math
from itertools import pairwise

import networkx as nx
import pytest

from tests.judging.roads import crossroads
from tmpud.geometry import Polyline
from tmpud.motion.mapping import RoadPoint, StateMapping
from tmpud.motion.path import Change, Cross, Follow, Move, find_path, outline
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import PAPER, TMPUD
from tmpud.roads import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition
from tmpud.task.domain import Domain

TOWN = load_map("millbrook")
TINY = crossroads()


def anywhere(network: RoadNetwork) -> ServiceRequest:
    first, *_, last = network.segments
    return ServiceRequest(Place("start", (first,)), (Place("goal", (last,)),))


def transitions(network: RoadNetwork) -> list[Transition]:
    domain = Domain(network, anywhere(network))
    return [step for segment in network.segments for step in domain.successors(State(segment, 0))]


def shortest(network: RoadNetwork, start: RoadPoint, goal: RoadPoint, action: Action) -> float:
    """Return the length of the shortest path without A*: Dijkstra on all that could be driven."""
    graph = nx.DiGraph()
    graph.add_nodes_from(("start", "goal"))
    lane = network.lanes[start.lane]
    if action.is_merge:
        target = network.neighbour(start.lane, action)
        if target is not None and network.may_change(start.lane, action) and goal.lane == target.id:
            ratio = target.length / lane.length
            room = goal.station / ratio - start.station
            if room >= 20.0:
                end = start.station + min(25.0, room)
                graph.add_edge("start", "across", weight=Change(lane, target, start.station, end).length)
                graph.add_edge("across", "goal", weight=goal.station - end * ratio)
    else:
        if start.lane == goal.lane and goal.station > start.station:
            graph.add_edge("start", "goal", weight=goal.station - start.station)
        graph.add_edge("start", "line", weight=lane.length - start.station)
        for way in network.outgoing(start.lane):
            if way.action is action:
                graph.add_edge("line", way.to_lane, weight=way.path.length)
        if graph.has_node(goal.lane):
            graph.add_edge(goal.lane, "goal", weight=goal.station)
    found: float = nx.shortest_path_length(graph, "start", "goal", weight="weight") if _joined(graph) else math.inf
    return found


def _joined(graph: "nx.DiGraph[str]") -> bool:
    joined: bool = nx.has_path(graph, "start", "goal")
    return joined


@pytest.mark.parametrize("network", [TINY, TOWN], ids=lambda network: network.name)
def test_a_star_finds_the_shortest_path_for_every_transition(network: RoadNetwork) -> None:
    mapping = StateMapping(network, anywhere(network), TMPUD)
    paths = PathPlanner(network, mapping)
    steps = transitions(network)
    assert {step.action for step in steps} >= {Action.FORWARD, Action.MERGELEFT, Action.MERGERIGHT, Action.TURNLEFT}
    for step in steps:
        expected = shortest(network, mapping(step.state), mapping(step.next_state), step.action)
        assert paths.path_length(step) == pytest.approx(expected, abs=1e-6), step


@pytest.mark.parametrize("network", [TINY, TOWN], ids=lambda network: network.name)
def test_a_path_does_one_action_and_hangs_together(network: RoadNetwork) -> None:
    mapping = StateMapping(network, anywhere(network), TMPUD)
    paths = PathPlanner(network, mapping)
    for step in transitions(network):
        moves = paths.moves(mapping(step.state), step)
        if moves is None:
            continue
        assert sum(isinstance(move, Change) for move in moves) == step.action.is_merge
        assert sum(isinstance(move, Cross) for move in moves) <= 1
        points = [point for move in moves for point in outline(move)]
        assert math.dist(points[0], mapping.pose(step.state)[:2]) < 1e-6
        assert math.dist(points[-1], mapping.pose(step.next_state)[:2]) < 1e-6
        assert max(math.dist(a[-1], b[0]) for a, b in _pairs(moves)) < 0.5


def _pairs(moves: tuple[Move, ...]) -> list[tuple[list[tuple[float, float]], list[tuple[float, float]]]]:
    pieces = [outline(move) for move in moves]
    return [*pairwise(pieces), (pieces[-1], [pieces[-1][-1]])]


@pytest.mark.parametrize("network", [TINY, TOWN], ids=lambda network: network.name)
def test_a_length_is_the_arc_length_of_the_outline(network: RoadNetwork) -> None:
    paths = PathPlanner(network, StateMapping(network, anywhere(network), TMPUD))
    for step in transitions(network):
        for move in paths.moves(paths._mapping(step.state), step) or ():
            if move.length > 1e-6:
                assert Polyline(outline(move)).length == pytest.approx(move.length, rel=0.01)


@pytest.mark.parametrize(("room", "possible"), [(19.9, False), (20.1, True), (24.0, True), (60.0, True)])
def test_a_merge_needs_twenty_metres(room: float, possible: bool) -> None:
    goal = RoadPoint("in_1", 30.0 + room)
    moves = find_path(TINY, RoadPoint("in_0", 30.0), goal, Action.MERGELEFT)
    assert (moves is not None) is possible
    if moves is not None:
        assert isinstance(moves[0], Change)
        assert 20.0 <= moves[0].end - moves[0].start <= 25.0


def test_a_path_neither_goes_back_nor_does_another_action() -> None:
    back = RoadPoint("in_0", 20.0)
    assert find_path(TINY, RoadPoint("in_0", 30.0), back, Action.FORWARD) is None
    assert find_path(TINY, back, RoadPoint("in_1", 80.0), Action.FORWARD) is None
    assert find_path(TINY, back, RoadPoint("in_1", 80.0), Action.MERGERIGHT) is None
    assert find_path(TINY, back, RoadPoint("in_0", 80.0), Action.MERGELEFT) is None
    assert find_path(TINY, back, RoadPoint("out_0", 5.0), Action.TURNRIGHT) is None
    assert find_path(TINY, back, RoadPoint("out_1", 5.0), Action.MERGELEFT) is None


def test_staying_where_one_is_takes_no_path() -> None:
    here = RoadPoint("in_0", 30.0)
    assert find_path(TINY, here, here, Action.FORWARD) == ()


def test_lanes_of_a_transition_include_those_through_the_junction() -> None:
    paths = PathPlanner(TINY, StateMapping(TINY, anywhere(TINY), TMPUD))
    across = Transition(State("in_1/1", 0), Action.TURNLEFT, State("north_0/0", 0))
    assert paths.lanes(across) == ("in_1", ":J_2_0", "north_0")
    merge = Transition(State("in_0/0", 0), Action.MERGELEFT, State("in_1/1", 0))
    assert set(paths.lanes(merge)) >= {"in_0", "in_1"}


# f(s) --------------------------------------------------------------------------------------------------------------


def test_a_state_is_at_its_segments_middle() -> None:
    where = StateMapping(TINY, anywhere(TINY), TMPUD)
    assert where(State("in_0/1", 0)) == RoadPoint("in_0", 75.0)
    assert where.pose(State("in_1/0", 0)) == pytest.approx((25.0, 3.2, 0.0))


def test_a_start_and_goals_that_are_positions_are_there_in_their_own_leg() -> None:
    request = ServiceRequest(Place("12,0", ("in_0/0",), 12.0), (Place("60,0", ("in_0/1",), 60.0),))
    where = StateMapping(TINY, request, TMPUD)
    assert where(State("in_0/0", 0)).station == 12.0
    assert where(State("in_0/0", 1)).station == 25.0
    assert where(State("in_0/1", 0)).station == 75.0
    assert where(State("in_0/1", 1)).station == 60.0


def test_positions_hold_where_one_place_reaches_several_goals_at_once() -> None:
    lane = Place("in_0", ("in_0/0", "in_0/1"))
    from_there = StateMapping(TINY, ServiceRequest(Place("12,0", ("in_0/0",), 12.0), (lane, lane)), TMPUD)
    assert from_there(State("in_0/0", 2)).station == 12.0
    to_there = StateMapping(TINY, ServiceRequest(lane, (Place("60,0", ("in_0/1",), 60.0), lane)), TMPUD)
    assert to_there(State("in_0/1", 2)).station == 60.0, "being at the position is being on the lane"


def test_a_position_is_reached_at_the_position_also_where_lanes_are_not_cut() -> None:
    uncut = load_map("millbrook", math.inf)
    lane = uncut.lanes["park1e_1"]
    behind = Place("behind", ("park1e_1/0",), 30.0)
    ask = ServiceRequest(Place("start", ("park1e_0/0",), 50.0), (behind,))
    paths = PathPlanner(uncut, StateMapping(uncut, ask, PAPER))
    merge = Transition(State("park1e_0/0", 0), Action.MERGELEFT, State("park1e_1/0", 1))
    assert lane.length > 100
    assert paths.path_length(merge) == math.inf
    anywhere = Transition(State("park1e_0/0", 0), Action.MERGELEFT, State("park1e_1/0", 0))
    assert paths.path_length(anywhere) < 40
    assert paths.lanes(anywhere) == ("park1e_0", "park1e_1")


def test_sampled_poses_are_in_the_middle_third_and_the_seed_decides_them() -> None:
    states = [State(segment, 0) for segment in TOWN.segments]
    one, same, other = (StateMapping(TOWN, anywhere(TOWN), PAPER, seed) for seed in (1, 1, 2))
    assert [one(state) for state in states] == [same(state) for state in states]
    assert [one(state) for state in states] != [other(state) for state in states]
    for state in states:
        segment = TOWN.segments[state.segment]
        share = (one(state).station - segment.start) / (segment.end - segment.start)
        assert 1 / 3 - 1e-9 <= share <= 2 / 3 + 1e-9


def test_following_a_lane_is_as_long_as_the_stations_say() -> None:
    assert Follow(TINY.lanes["in_0"], 10.0, 35.0).length == 25.0
