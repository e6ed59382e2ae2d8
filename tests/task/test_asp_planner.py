import math
import random
from itertools import pairwise

import pytest

from benchmarks.nets import net_file
from benchmarks.questions import graph_of
from tests.task.agreement import Case, random_case
from tests.task.oracle import order, simple_plans, triple
from tests.task.tiny_roads import driven, grid, link, network, request, road, two_blocks
from tmpud.errors import NoPlanError
from tmpud.presets import PAPER, TMPUD, Preset, preset_named
from tmpud.roads import load_map
from tmpud.symbols import Action, LazyCost, OptimisticSafe, Place, ServiceRequest, State, TaskPlan, Transition
from tmpud.task.asp_planner import AspPlanner

HOME = State("a_0/0", 0)
HALF = preset_named("tmpud:gamma=2500")  # at most 578 m of penalty

AREA_1 = Transition(HOME, Action.MERGELEFT, State("a_1/1", 0))
AREA_2 = Transition(State("b_0/0", 0), Action.MERGELEFT, State("b_1/1", 0))


def actions(plan: TaskPlan) -> str:
    return " ".join(step.action for step in plan)


def test_the_worked_case_merges_early_then_late_then_goes_round_the_block() -> None:
    roads, goal, safe = two_blocks(100.0), request("a_0/0", "goal_0/0"), OptimisticSafe()
    planner, cost = AspPlanner(roads, TMPUD), driven(roads)
    plan_a = planner.solve(HOME, goal, cost, safe)
    assert actions(plan_a.plan) == "mergeleft forward forward turnleft"
    safe[AREA_1] = 0.0
    plan_b = planner.solve(HOME, goal, cost, safe)
    assert actions(plan_b.plan) == "forward forward mergeleft turnleft"
    assert (plan_b.cost_m, plan_b.penalty_m) == (plan_a.cost_m, 0.0)
    safe[AREA_2] = 0.0
    round_the_block = planner.solve(HOME, goal, cost, safe)
    assert [step.state.segment[0] for step in round_the_block.plan] == list("aabbccddeeff")
    assert round_the_block.cost_m - plan_a.cost_m == pytest.approx(440.0)
    assert round_the_block.penalty_m == 0.0


@pytest.mark.parametrize(("preset", "block"), [(HALF, 140.0), (PAPER, 100.0)])
def test_an_unsafe_merge_is_taken_where_the_block_costs_more(preset: Preset, block: float) -> None:
    roads, safe = two_blocks(block), OptimisticSafe()
    safe[AREA_1] = safe[AREA_2] = 0.0
    report = AspPlanner(roads, preset).solve(HOME, request("a_0/0", "goal_0/0"), driven(roads), safe)
    assert actions(report.plan) == "mergeleft forward forward turnleft"
    assert report.penalty_m == pytest.approx(577.65 + 1250.0 * 4 * preset.constant_term, abs=0.01)


def test_the_literal_formula_charges_half_gamma_for_every_further_action() -> None:
    roads, goal = two_blocks(100.0), request("a_0/0", "goal_0/0")
    best, second, *_, longest = [
        AspPlanner(roads, PAPER).solve(HOME, goal, driven(roads), OptimisticSafe()),
        *AspPlanner(roads, PAPER).alternatives(HOME, goal, driven(roads), OptimisticSafe(), 5),
    ]
    assert best.penalty_m == second.penalty_m == 4 * 1250.0
    assert longest.penalty_m == len(longest.plan) * 1250.0 == 12 * 1250.0


def test_a_lane_is_driven_twice_where_the_goals_ask_for_it() -> None:
    roads = network([road("a", 2, 100.0), road("b")], [link("a_1", "b_0"), link("b_0", "a_0"), link("a_0", "b_0")])
    goal = request("a_0/0", "a_1/1", "a_0/1", "a_1/1")
    plan = AspPlanner(roads).plan(HOME, goal, driven(roads), OptimisticSafe())
    assert [step.next_state for step in plan] == [
        State("a_1/1", 1), State("b_0/0", 1), State("a_0/0", 1), State("a_0/1", 2),
        State("b_0/0", 2), State("a_0/0", 2), State("a_1/1", 3),
    ]  # fmt: skip


def test_a_position_ahead_is_driven_on_to_and_one_behind_is_come_back_to() -> None:
    roads = network([road("a")], [link("a_0", "a_0", Action.TURNLEFT)])
    goal = ServiceRequest(Place("here", ("a_0/0",)), (Place("there", ("a_0/0",), 30.0),))
    drive_on = Transition(HOME, Action.FORWARD, State("a_0/0", 1))
    ahead = LazyCost(lambda step: 5.0 if step == drive_on else 60.0)
    behind = LazyCost(lambda step: math.inf if step == drive_on else 60.0)
    assert actions(AspPlanner(roads).plan(HOME, goal, ahead, OptimisticSafe())) == "forward"
    assert actions(AspPlanner(roads).plan(HOME, goal, behind, OptimisticSafe())) == "turnleft"


@pytest.mark.parametrize("prune", [True, False])
def test_odd_lane_ids_are_quoted(prune: bool) -> None:
    odd = ['"', "\\", '\\"', "-1#0:x%*", "_ö).", "not a, b"]
    roads = network([road(edge) for edge in odd], [link(f"{a}_0", f"{b}_0") for a, b in pairwise(odd)])
    goal = request('"_0/0', "not a, b_0/0")
    plan = AspPlanner(roads, prune=prune).plan(State('"_0/0', 0), goal, driven(roads), OptimisticSafe())
    assert [step.next_state.segment for step in plan] == [f"{edge}_0/0" for edge in odd[1:]]


def test_nothing_is_left_to_do_at_the_goal() -> None:
    roads = two_blocks(100.0)
    report = AspPlanner(roads).solve(State("a_0/0", 1), request("a_0/0", "a_0/0"), driven(roads), OptimisticSafe())
    assert (report.plan, report.total_cm, report.optimal) == ((), 0, True)


def test_the_same_question_has_the_same_report() -> None:
    roads, goal = two_blocks(100.0), request("a_0/0", "goal_0/0")
    first, again = (AspPlanner(roads).solve(HOME, goal, driven(roads), OptimisticSafe()) for _ in range(2))
    assert first == again
    assert (
        first.transitions
        < AspPlanner(roads, prune=False).solve(HOME, goal, driven(roads), OptimisticSafe()).transitions
    )


def test_a_plan_is_followed_by_its_own_rest() -> None:
    for seed in range(60):
        case = random_case(random.Random(seed))
        plan = _plan(case, State(case.request.start.segments[0], 0))
        for i, step in enumerate(plan):
            assert _plan(case, step.state) == plan[i:]


def test_cheaper_costs_are_seen_in_another_mapping_and_by_the_literal_preset() -> None:
    roads, goal = two_blocks(100.0), request("a_0/0", "goal_0/0")
    cost = LazyCost(lambda _: 100.0)
    for preset, floored in ((TMPUD, 400.0), (PAPER, 202.0)):
        planner = AspPlanner(roads, preset)
        planner.plan(HOME, goal, cost, OptimisticSafe())
        changed = cost
        cost = LazyCost(lambda _: 100.0)
        changed.update({AREA_1: 1.0, Transition(State("b_1/1", 0), Action.TURNLEFT, State("goal_0/0", 1)): 1.0})
        assert planner.solve(HOME, goal, changed, OptimisticSafe()).cost_m == floored
        assert planner.solve(HOME, goal, dict(changed), OptimisticSafe()).cost_m == 202.0


def test_the_solver_gives_the_best_plan_it_has_when_it_reaches_its_limit() -> None:
    roads, cost = grid(4), driven(grid(4))
    goal, start = request("0.0-E_0/0", "3.3-W_1/0"), State("0.0-E_0/0", 0)
    best = AspPlanner(roads).solve(start, goal, cost, OptimisticSafe())
    hasty = AspPlanner(roads, prune=False, conflicts=40).solve(start, goal, cost, OptimisticSafe())
    assert best.optimal
    assert not hasty.optimal
    assert hasty.total_cm >= best.total_cm
    with pytest.raises(NoPlanError, match="gave up"):
        AspPlanner(roads, prune=False, conflicts=1).plan(start, goal, cost, OptimisticSafe())


def test_that_none_of_many_equally_good_ways_is_better_takes_no_search() -> None:
    with net_file("grid:18:2:even") as file:
        graph = graph_of(load_map(str(file)))
    asked = request("E12E13_0/0", "Q8Q7_1/0")
    planner = AspPlanner(graph.network, conflicts=100)
    found = planner.solve(asked.start_state(), asked, graph.cost, OptimisticSafe())
    assert found.transitions > 3 * len(found.plan)
    assert found.optimal


@pytest.mark.parametrize("seed", range(60))
def test_alternatives_are_the_next_best_simple_plans(seed: int) -> None:
    case = random_case(random.Random(seed))
    case.change(_start(case))
    case.first = dict(case.cost)
    weights, last = case.weights(), len(case.request.goals)
    plans = simple_plans(_start(case), last, weights, 4000)
    if plans is None or not plans or not plans[0]:
        return
    plans.sort(key=lambda plan: (triple(plan, weights), order(plan)))
    planner = AspPlanner(case.network, case.preset)
    found = planner.alternatives(_start(case), case.request, case.cost, case.safe, 5)
    assert [report.plan for report in found] == plans[1:6]
    assert [report.total_cm for report in found] == [triple(plan, weights)[0] for plan in plans[1:6]]


def _start(case: Case) -> State:
    return State(case.request.start.segments[0], 0)


def _plan(case: Case, state: State) -> TaskPlan:
    try:
        return AspPlanner(case.network, case.preset).plan(state, case.request, case.cost, case.safe)
    except NoPlanError:
        return ()
