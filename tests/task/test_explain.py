import math

import pytest

from tests.task.tiny_roads import driven, link, network, request, road, two_blocks
from tmpud.errors import NoPlanError
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action, Cost, OptimisticSafe, ServiceRequest, State, Transition
from tmpud.task.asp_planner import AspPlanner

HOME = State("a_0/0", 0)
THREE = [road("a", 2, 100.0), road("b"), road("c")]


def refusal(roads: RoadNetwork, goal: ServiceRequest, cost: Cost, prune: bool) -> str:
    with pytest.raises(NoPlanError) as caught:
        AspPlanner(roads, prune=prune).plan(HOME, goal, cost, OptimisticSafe())
    return str(caught.value)


@pytest.mark.parametrize("prune", [True, False])
def test_a_goal_without_a_way_in(prune: bool) -> None:
    roads = network(THREE, [link("a_0", "b_0"), link("b_0", "a_0")])
    assert refusal(roads, request("a_0/0", "b_0/0", "c_0/0"), driven(roads), prune) == (
        "leg 2 of 2: goal c_0/0 is cut off from a_0/0; 4 segments can be reached; nothing leads to the goal"
    )


@pytest.mark.parametrize("prune", [True, False])
def test_a_start_without_a_way_out(prune: bool) -> None:
    roads = network([road("a"), *THREE[1:]], [link("b_0", "c_0")])
    assert refusal(roads, request("a_0/0", "c_0/0"), driven(roads), prune) == (
        "leg 1 of 1: goal c_0/0 is cut off from a_0/0; 1 segment can be reached; nothing leads out of a_0/0"
    )


def test_a_gap_between_the_start_and_the_goal() -> None:
    roads = network(THREE, [link("a_0", "a_0"), link("b_0", "c_0")])
    assert refusal(roads, request("a_0/0", "c_0/0"), driven(roads), True) == (
        "leg 1 of 1: goal c_0/0 is cut off from a_0/0; 3 segments can be reached; "
        "nothing leads from there to the lanes before the goal: b_0"
    )


@pytest.mark.parametrize("prune", [True, False])
def test_forbidden_transitions_in_the_way(prune: bool) -> None:
    roads = two_blocks(100.0)
    lengths = driven(roads)
    cost = {
        step: math.inf if step.action.is_merge or step.next_state.segment == "c_0/0" else lengths[step]
        for step in _steps(roads)
    }
    assert refusal(roads, request("a_0/0", "goal_0/0"), cost, prune) == (
        "leg 1 of 1: goal goal_0/0 is cut off from a_0/0; 4 segments can be reached; "
        "forbidden: mergeleft from a_0/0 to a_1/1, mergeleft from b_0/0 to b_1/1, forward from b_0/1 to c_0/0"
    )


def _steps(roads: RoadNetwork) -> list[Transition]:
    pairs = [(a, b) for a in roads.segments for b in roads.segments]
    legs = {"goal_0/0": 1}
    return [Transition(State(a, 0), action, State(b, legs.get(b, 0))) for a, b in pairs for action in Action]
