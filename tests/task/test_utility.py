import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.task.tiny_roads import driven, link, network, request, road
from tmpud.errors import UtilityOverflowError
from tmpud.presets import PAPER, RELEASED, TMPUD
from tmpud.symbols import Action, OptimisticSafe, State, Transition
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.utility import FORBIDDEN, Utility, penalty, split

TURN = Transition(State("a_0/0", 0), Action.TURNLEFT, State("b_0/0", 0))
MERGE = Transition(State("a_0/0", 0), Action.MERGELEFT, State("a_1/1", 0))


@given(st.floats(0, 1), st.floats(0, 1))
def test_the_penalty_falls_with_safety_and_presets_differ_by_half_gamma(a: float, b: float) -> None:
    low, high = sorted((a, b))
    assert penalty(low, TMPUD) >= penalty(high, TMPUD) >= 0
    assert penalty(a, PAPER) - penalty(a, RELEASED) == pytest.approx(1250)
    assert penalty(a, PAPER) == pytest.approx(2500 / (1 + math.exp(a - 1)))


def test_the_penalties_of_the_released_code_are_met() -> None:
    assert [round(penalty(safe, RELEASED), 1) for safe in (1.0, 0.5, 0.0)] == [0.0, 306.1, 577.6]


@pytest.mark.parametrize("safe", [-0.1, 1.1, math.nan])
def test_a_safe_value_outside_its_range_is_refused(safe: float) -> None:
    with pytest.raises(ValueError, match="Safe is"):
        penalty(safe, TMPUD)


def test_terms_are_told_apart_and_rounded_once() -> None:
    utility = Utility(RELEASED, {TURN: 10.004}, {TURN: 0.5}, {})
    assert utility.terms(TURN) == pytest.approx((10.004, 306.148, 25.0), abs=1e-3)
    assert split(utility.rank(TURN)) == (34115, 0, 1)


def test_ranks_count_merges_and_actions_and_add_up() -> None:
    utility = Utility(TMPUD, {TURN: 3.0, MERGE: 4.0}, OptimisticSafe(), {})
    assert split(utility.rank(TURN) + utility.rank(MERGE)) == (700, 1, 2)


def test_a_cost_below_its_first_value_counts_as_that_value() -> None:
    utility = Utility(TMPUD, {TURN: 3.0}, OptimisticSafe(), {TURN: 5.0})
    assert utility.total((TURN, TURN)) == ((10.0, 0.0, 0.0), 10_00, ((5.0, 0.0, 0.0), (5.0, 0.0, 0.0)))


@pytest.mark.parametrize(
    ("cost", "safe", "unchanged"),
    [(5.0, 1.0, True), (3.0, 1.0, True), (5.01, 1.0, False), (5.0, 0.999, False), (math.nan, 1.0, False)],
)
def test_a_rank_is_unchanged_where_no_weight_is_above_its_floor(cost: float, safe: float, unchanged: bool) -> None:
    assert Utility(TMPUD, {TURN: cost}, {TURN: safe}, {TURN: 5.0}).unchanged(TURN) == unchanged
    assert not Utility(TMPUD, {TURN: cost}, {TURN: safe}, {}).unchanged(TURN)


def test_what_cannot_be_driven_is_forbidden() -> None:
    assert Utility(TMPUD, {TURN: math.inf}, OptimisticSafe(), {}).rank(TURN) == FORBIDDEN


@pytest.mark.parametrize("cost", [21_474_836.48, 1e300, -0.01, math.nan])
def test_a_cost_that_the_solver_cannot_hold_is_refused(cost: float) -> None:
    with pytest.raises(UtilityOverflowError, match="turnleft on a_0/0"):
        Utility(TMPUD, {TURN: cost}, OptimisticSafe(), {}).rank(TURN)


@pytest.mark.parametrize("prune", [True, False])
def test_a_plan_whose_total_the_solver_cannot_hold_is_refused(prune: bool) -> None:
    roads = network([road("a"), road("b"), road("c")], [link("a_0", "b_0"), link("b_0", "c_0")])
    goal = request("a_0/0", "c_0/0")
    dear = dict.fromkeys(_line(), 12_000_000.0)
    with pytest.raises(UtilityOverflowError, match="a plan could cost 24000000"):
        AspPlanner(roads, prune=prune).plan(State("a_0/0", 0), goal, dear, OptimisticSafe())
    assert len(AspPlanner(roads, prune=prune).plan(State("a_0/0", 0), goal, driven(roads), OptimisticSafe())) == 2


def _line() -> list[Transition]:
    states = [State("a_0/0", 0), State("b_0/0", 0), State("c_0/0", 1)]
    return [Transition(a, Action.FORWARD, b) for a, b in pairwise(states)]
