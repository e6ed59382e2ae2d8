import random
from itertools import product

import pytest

from tests.task.agreement import random_case
from tests.task.oracle import transitions
from tests.task.tiny_roads import link, network, request, road
from tmpud.errors import RequestError
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition
from tmpud.task.domain import Domain


@pytest.mark.parametrize("seed", range(40))
def test_successors_and_predecessors_are_the_transitions_of_the_map(seed: int) -> None:
    case = random_case(random.Random(seed))
    domain = Domain(case.network, case.request)
    states = [State(*pair) for pair in product(case.network.segments, range(domain.last + 1))]
    leaving = [transition for state in states for transition in domain.successors(state)]
    expected = transitions(case.network, case.request)
    assert len(leaving) == len(set(leaving))
    assert set(leaving) == expected
    assert {transition for state in states for transition in domain.predecessors(state)} == expected


def test_a_merge_leads_to_the_neighbouring_lanes_next_segment() -> None:
    domain = Domain(network([road("a", 2, 100.0)], []), request("a_0/0", "a_1/1"))
    assert set(domain.successors(State("a_0/0", 0))) == {
        Transition(State("a_0/0", 0), Action.FORWARD, State("a_0/1", 0)),
        Transition(State("a_0/0", 0), Action.MERGELEFT, State("a_1/1", 1)),
    }
    assert domain.successors(State("a_0/1", 0)) == ()


def test_turnarounds_are_left_out() -> None:
    roads = network([road("a"), road("b")], [link("a_0", "b_0", Action.TURNLEFT, turnaround=True)])
    assert Domain(roads, request("a_0/0", "b_0/0")).successors(State("a_0/0", 0)) == ()


def test_goals_that_the_start_serves_are_done_but_not_a_position() -> None:
    roads = network([road("a")], [])
    here, there = Place("here", ("a_0/0",)), Place("there", ("a_0/0",), 40.0)
    assert Domain(roads, ServiceRequest(here, (here, here))).start_state() == State("a_0/0", 2)
    domain = Domain(roads, ServiceRequest(here, (here, there, here)))
    assert domain.start_state() == State("a_0/0", 1)
    step = Transition(State("a_0/0", 1), Action.FORWARD, State("a_0/0", 3))
    assert domain.successors(State("a_0/0", 1)) == (step,)


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        (Place("shop", ()), "shop: it has no segment"),
        (Place("shop", ("x_0/0",)), "shop: segment 'x_0/0' is not on the map tiny"),
        (Place("shop", ("a_0/0", "a_1/0"), 3.0), "shop: a position lies on one segment, not on 2"),
    ],
)
def test_places_that_the_map_does_not_have_are_refused(goal: Place, message: str) -> None:
    with pytest.raises(RequestError, match=message):
        Domain(network([road("a", 2)], []), ServiceRequest(Place("home", ("a_0/0",)), (goal,)))


def test_a_request_without_goals_and_states_of_nowhere_are_refused() -> None:
    roads = network([road("a")], [])
    with pytest.raises(RequestError, match="at least one goal"):
        Domain(roads, request("a_0/0"))
    for state in (State("x", 0), State("a_0/0", 2), State("a_0/0", -1)):
        with pytest.raises(RequestError, match="not a state"):
            Domain(roads, request("a_0/0", "a_0/0")).check(state)
