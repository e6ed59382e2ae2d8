import random

import pytest

from tests.task.tiny_roads import driven, grid, network, request, road
from tmpud.errors import NoPlanError
from tmpud.presets import TMPUD
from tmpud.symbols import OptimisticSafe, State
from tmpud.task.search_planner import SearchPlanner


def test_its_plan_is_the_one_that_clingo_proves_while_safe_changes_along_the_way() -> None:
    rng = random.Random(3)
    town = grid(4, rng)
    planner, cost, safe = SearchPlanner(town, TMPUD), driven(town), OptimisticSafe()
    wanted = request("0.0-E_0/0", "3.3-S_0/1")
    state, replans = wanted.start_state(), 0
    while state.leg == 0:
        found = planner.solve(state, wanted, cost, safe)
        proof = planner.prove(state, wanted, cost, safe)
        assert (found.plan, found.total_cm) == (proof.plan, proof.total_cm)
        assert proof.optimal
        assert not found.optimal
        if found.plan[0] not in safe:
            safe[found.plan[0]] = rng.choice((0.0, 0.3, 0.9, 1.0))
            replans += 1
        else:
            state = found.plan[0].next_state
    assert replans >= 5


def test_it_says_so_where_there_is_no_plan() -> None:
    apart = network([road("a"), road("b", y=100.0)], [])
    with pytest.raises(NoPlanError, match="a_0/0"):
        SearchPlanner(apart).solve(State("a_0/0", 0), request("a_0/0", "b_0/0"), driven(apart), OptimisticSafe())


def test_at_the_goal_nothing_is_left_to_do() -> None:
    town = grid(2)
    there = request("0.0-E_0/0", "0.0-E_0/1")
    assert SearchPlanner(town).solve(State("0.0-E_0/1", 1), there, driven(town), OptimisticSafe()).plan == ()
