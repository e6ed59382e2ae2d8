import random

import pytest

from tests.task.ruled import compare
from tests.task.tiny_roads import driven, grid, request, two_blocks
from tmpud.errors import NoPlanError, RulesError, UtilityOverflowError
from tmpud.symbols import OptimisticSafe, State
from tmpud.task.asp_planner import AspPlanner, PlanReport
from tmpud.task.rules import read_rules

HOME = State("a_0/0", 0)


def solve(text: str, *, prune: bool = True) -> PlanReport:
    """Return the plan from the first lane to the goal of ``two_blocks`` under some rules."""
    roads = two_blocks(100.0)
    planner = AspPlanner(roads, prune=prune, rules=read_rules(text, "my.lp"))
    return planner.solve(HOME, request("a_0/0", "goal_0/0"), driven(roads), OptimisticSafe())


def edges(report: PlanReport) -> str:
    """Return the first letters of the edges that a plan drives on, in order."""
    return "".join(dict.fromkeys(step.next_state.segment[0] for step in report.plan))


def test_a_plan_under_rules_is_the_best_of_all_that_they_allow() -> None:
    tally = compare(200, seed=1)
    assert tally.mismatches == []
    assert tally.enumerated > tally.plans / 2
    assert 0 < tally.without_plan < tally.plans
    assert tally.rounds > 2


def test_an_edge_can_be_forbidden_made_dearer_and_demanded() -> None:
    assert edges(solve("")) == "abg"
    assert edges(solve(':- onlane("b_1").')) == "abcdefg"
    assert edges(solve(':- not onlane("e_0").')) == "abcdefg"
    dearer = solve(':~ onlane("b_1"). [43900@3, "b"]')
    assert (edges(dearer), dearer.rules_m, dearer.rounds) == ("abg", 439.0, 2)
    assert edges(solve(':~ onlane("b_1"). [44100@3, "b"]')) == "abcdefg"


def test_rules_of_ones_own_may_use_the_roads_which_is_proved_on_the_whole_map() -> None:
    told = solve('left(S) :- leftof(S,_). :- visit(S,_), left(S), not goal(_,S), S != "a_1/1".')
    assert [step.action for step in told.plan] == ["forward", "forward", "mergeleft", "turnleft"]
    assert told.rounds == 1
    assert told.transitions == solve("", prune=False).transitions


def test_rules_that_no_plan_keeps_are_named_after_the_whole_map_was_tried() -> None:
    with pytest.raises(NoPlanError, match=r"^no plan keeps the rules of my\.lp; without them there is one$"):
        solve(':- onedge("b").')


def test_of_equal_plans_the_preferred_one_that_keeps_the_rules_is_taken() -> None:
    either = ':- onlane("a_1"), not onlane("e_0"). :- onlane("e_0"), not onlane("a_1").'
    assert [step.action for step in solve(either).plan] == ["forward", "forward", "mergeleft", "turnleft"]


def test_pruning_under_rules_stays_small_on_a_town() -> None:
    roads = grid(6, random.Random(1))
    goal, cost = request("0.0-E_0/0", "5.5-W_1/1"), driven(roads)
    free = AspPlanner(roads).solve(goal.start_state(), goal, cost, OptimisticSafe())
    middle = free.plan[len(free.plan) // 2].state.segment
    rules = read_rules(f':- visit("{middle}",_).', "my.lp")
    around = AspPlanner(roads, rules=rules).solve(goal.start_state(), goal, cost, OptimisticSafe())
    assert middle not in {step.state.segment for step in around.plan}
    assert around.total_cm >= free.total_cm
    whole = AspPlanner(roads, prune=False).instance(goal.start_state(), goal, cost, OptimisticSafe())
    assert around.transitions < whole.count("weight(") / 2


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("\n:- onlane(\n", r"my\.lp:3: syntax error, unexpected EOF"),
        ("% fine\n:- a b.", r"my\.lp:2: syntax error, unexpected <IDENTIFIER>"),
        (':- onedge("a"), X < Y.', r"my\.lp:1: 'X' is unsafe"),
        ("\n:- vist(S,_).", r"my\.lp:2: nothing defines vist/2; there are do/4"),
        (":- onedge(a).", r'my\.lp:1: a needs quotes, as the name of every edge does: "a"'),
        (":~ onedge(E). [-5@3,E]", "cost -5 is not a number of centimetres from 0 up"),
        (":~ visit(S,L). [L@3,S]", "cost L is not"),
        (":~ onedge(E). [5@4,E]", "priority 4 is not a number up to 3"),
        (":~ onedge(E). [4294967296@3,E]", "4294967296 is too large a number"),
        ('do("a",0,forward,"b").', "do/4 is the planner's own"),
        ('{ bad("a") }.', "rules choose nothing"),
        ("a(X) :- b(X). b(X) :- a(X), onlane(X).", "depends on itself"),
        ("a(X+1) :- a(X). a(0).", "a/1 depends on itself"),
        ("a(1..2000000000).", r"\(1\.\.2000000000\) is|too large"),
        ("a(1..99).", "an interval can be endless"),
        ("a(@f(1)).", "rules run no code"),
        ("#script (python)\ndef main(p): raise SystemExit\n#end.", "Script is not allowed"),
        ('#include "/etc/passwd".', "#include and binary data"),
        ("#show do/4.", "ShowSignature is not allowed"),
        ("#const forward=mergeleft.", "Definition is not allowed"),
        ("#program other.", "Program is not allowed"),
        ("#external a.", "External is not allowed"),
        (":- &diff { a } > 2.", "there are no theories"),
        (":- a\0b.", "binary data"),
    ],
)
def test_what_is_not_allowed_in_rules_is_refused_with_its_line(text: str, said: str) -> None:
    with pytest.raises(RulesError, match=said):
        read_rules(text, "my.lp")


def test_names_that_the_map_does_not_have_are_refused() -> None:
    with pytest.raises(RulesError, match=r"my\.lp:2: lane 'a_7' is not on tiny; there is \['a_1', 'a_0', '-a_1'\]"):
        solve('\n:- onlane("a_7").')


def test_costs_that_would_wrap_in_the_solver_are_refused() -> None:
    with pytest.raises(UtilityOverflowError, match="together"):
        solve("#minimize { 999999999@3,S : visit(S,_) }.")
