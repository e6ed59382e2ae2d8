import random
import re
import subprocess
import sys
from importlib.resources import as_file, files
from pathlib import Path

import clingo
import pytest

from tests.task.tiny_roads import driven, grid, request, two_blocks
from tmpud.symbols import OptimisticSafe, State, Transition
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.facts import ENCODING

ROAD = """
ahead(a2,a1). ahead(b2,b1). leftof(b1,a1). leftof(b2,a2). connected(b2,turnleft,c1). connected(a2,forward,d1).
connected(d1,turnleft,c1). connected(c1,forward,a1). start(a1,0).
"""


def plans(text: str) -> list[list[str]]:
    """Return the optimal answers of the whole encoding on some facts, each sorted."""
    control = clingo.Control(["--opt-mode=optN", "--models=0"])
    for name in ENCODING:
        control.add(files("tmpud.task").joinpath(name).read_text("utf-8"))
    control.add(text)
    control.ground()
    with control.solve(yield_=True) as handle:
        return [sorted(map(str, model.symbols(shown=True))) for model in handle if model.optimality_proven]


def weights(legs: int = 1, **other: int) -> str:
    """Give every move on the road 10 cm in each leg, or another weight by its target."""
    moves = "a1,L,forward,a2 b1,L,forward,b2 a1,L,mergeleft,b2 b1,L,mergeright,a2 b2,L,turnleft,c1 a2,L,forward,d1"
    every = f"{moves} d1,L,turnleft,c1 c1,L,forward,a1".split()
    rows = (move.replace("L", str(leg)) for leg in range(legs) for move in every)
    return " ".join(f"weight({row},{other.get(row.split(',')[-1], 10)})." for row in rows)


def test_the_shortest_plan_is_taken() -> None:
    assert plans(f"{ROAD} goal(0,c1). last(1). {weights()}") == [["do(a1,0,mergeleft,b2)", "do(b2,0,turnleft,c1)"]]


def test_a_merge_needs_a_lane_at_its_side_and_a_segment_ahead() -> None:
    no_lane = ROAD.replace("leftof(b1,a1).", "")
    assert plans(f"{no_lane} goal(0,c1). last(1). {weights()}")[0][0] == "do(a1,0,forward,a2)"
    assert plans(f"{ROAD.replace('ahead(b2,b1).', '')} goal(0,b2). last(1). {weights()}") == []


def test_what_has_no_weight_is_not_done() -> None:
    assert plans(f"{ROAD} goal(0,c1). last(1). {weights()}".replace("weight(a1,0,mergeleft,b2,10).", ""))[0] == [
        "do(a1,0,forward,a2)",
        "do(a2,0,forward,d1)",
        "do(d1,0,turnleft,c1)",
    ]


def test_of_equal_centimetres_the_fewest_merges_win_and_then_the_fewest_actions() -> None:
    assert plans(f"{ROAD} goal(0,c1). last(1). {weights(b2=20)}")[0][0] == "do(a1,0,forward,a2)"
    assert (
        len(
            plans(f"{ROAD} goal(0,c1). last(1). connected(a1,turnleft,c1). weight(a1,0,turnleft,c1,20). {weights()}")[0]
        )
        == 1
    )


def test_goals_are_reached_in_their_order() -> None:
    answer = plans(f"{ROAD} goal(0,c1). goal(1,d1). goal(2,c1). last(3). {weights(3)}")
    assert answer == [
        [
            "do(a1,0,mergeleft,b2)",
            "do(a1,1,forward,a2)",
            "do(a2,1,forward,d1)",
            "do(b2,0,turnleft,c1)",
            "do(c1,1,forward,a1)",
            "do(d1,2,turnleft,c1)",
        ]
    ]


def test_goals_on_one_segment_are_reached_together_unless_one_is_a_position() -> None:
    both = f"{ROAD} goal(0,b2). goal(1,b2). last(2). {weights(2)}"
    assert plans(both) == [["do(a1,0,mergeleft,b2)"]]
    assert plans(f"{both} position(1). weight(b2,1,forward,b2,5).") == [
        ["do(a1,0,mergeleft,b2)", "do(b2,1,forward,b2)"]
    ]


def test_there_is_no_plan_without_a_way() -> None:
    assert plans(f"{ROAD} goal(0,b1). last(1). {weights()}") == []


@pytest.mark.parametrize("prune", [True, False])
def test_plain_clingo_finds_the_same_optimum_from_the_dumped_facts(prune: bool, tmp_path: Path) -> None:
    roads, safe = two_blocks(100.0), OptimisticSafe()
    goal, state = request("a_0/0", "b_0/1", "goal_0/0"), State("a_0/0", 0)
    planner = AspPlanner(roads, prune=prune)
    for step in planner.plan(state, goal, driven(roads), safe):
        safe[step] = 0.7
    report = planner.solve(state, goal, driven(roads), safe)
    text = planner.instance(state, goal, driven(roads), safe)
    assert optimum(text, tmp_path) == [report.total_cm, merges(report.plan), len(report.plan)]


def test_plain_clingo_agrees_on_a_town(tmp_path: Path) -> None:
    roads = grid(4, random.Random(3))
    goal, state = request("0.0-E_0/0", "3.3-W_1/1"), State("0.0-E_0/0", 0)
    report = AspPlanner(roads).solve(state, goal, driven(roads), OptimisticSafe())
    text = AspPlanner(roads).instance(state, goal, driven(roads), OptimisticSafe())
    assert optimum(text, tmp_path) == [report.total_cm, merges(report.plan), len(report.plan)]


def merges(plan: tuple[Transition, ...]) -> int:
    return sum(step.action.is_merge for step in plan)


def optimum(text: str, folder: Path) -> list[int]:
    """Run clingo as a user would, and return the last optimum it prints."""
    instance = folder / "facts.lp"
    instance.write_text(text, "utf-8")
    with as_file(files("tmpud.task")) as package:
        program = [str(package / name) for name in ENCODING]
        command = [sys.executable, "-m", "clingo", *program, str(instance)]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "OPTIMUM FOUND" in run.stdout
    assert run.stderr == ""
    return [int(value) for value in re.findall(r"^Optimization: (.*)$", run.stdout, re.MULTILINE)[-1].split()]
