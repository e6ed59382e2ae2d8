import json

import pytest

from tests.execution.scripted import Paths, ScriptedWorld
from tests.safety.fakes import car, scene
from tests.task.tiny_roads import driven, network, request, road
from tmpud.events import Event, Executed, Finished, Judged
from tmpud.execution.deliberation import Deliberation
from tmpud.execution.tmpud import run_tmpud
from tmpud.experiments.calibration.scenes import (
    WATCHED,
    Eager,
    LocalMergeScenes,
    local_tasks,
    merge_rows,
    town_tasks,
)
from tmpud.experiments.calibration.scores import SeenMerge
from tmpud.presets import TMPUD
from tmpud.scene import Outcome, Scene
from tmpud.symbols import Action, State, Transition
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.domain import Domain

FIRST = Transition(State("a_0/0", 0), Action.MERGELEFT, State("a_1/1", 0))
SECOND = Transition(State("a_1/1", 0), Action.MERGERIGHT, State("a_0/2", 0))


def seen(step: Transition, time: float) -> SeenMerge:
    empty = scene(ego=car(0, 0, name="ego"))
    return SeenMerge(Scene(time, empty.ego, empty.others, {}), step, {"tmpud": 0.5})


def judged(time: float, kind: str = "collision", rule: str = "merge") -> Judged:
    return Judged(time, kind, "other", rule, "ego", "")


def ended(time: float, status: str = "SUCCESS") -> Finished:
    return Finished(time, status, "", 0.0, 0.0, 0)


def outcomes(merges: list[SeenMerge], *log: Event) -> list[str]:
    return [row["outcome"] for row in merge_rows(merges, log)]


def test_a_merge_answers_for_eight_seconds() -> None:
    merges = [seen(FIRST, 10.0)]
    assert outcomes(merges, judged(18.0), ended(18.0, "COLLISION")) == ["collide"]
    assert outcomes(merges, judged(18.05), ended(18.05, "COLLISION")) == ["merge"]
    assert outcomes(merges, judged(12.0, "forced_stop", "merge"), ended(60.0)) == ["stop"]
    assert outcomes(merges, ended(60.0)) == ["merge"]


def test_of_two_merges_the_later_one_answers() -> None:
    merges = [seen(FIRST, 10.0), seen(SECOND, 15.0)]
    assert outcomes(merges, judged(16.0, "forced_stop"), ended(60.0)) == ["merge", "stop"]
    assert outcomes(merges, judged(14.0, "forced_stop"), ended(60.0)) == ["stop", "merge"]


@pytest.mark.parametrize("other", [judged(12.0, rule="crossing"), judged(12.0, "hard_braking"), judged(12.0, "jump")])
def test_only_collisions_of_merges_and_forced_stops_make_a_merge_unsafe(other: Judged) -> None:
    assert outcomes([seen(FIRST, 10.0)], other, ended(60.0)) == ["merge"]


def test_a_merge_whose_end_nobody_saw_is_left_out() -> None:
    assert outcomes([seen(FIRST, 10.0)], ended(17.9)) == []
    assert outcomes([seen(FIRST, 10.0)], judged(12.0, rule="crossing"), ended(12.0, "COLLISION")) == []


def test_a_merge_that_could_not_be_begun_is_left_out() -> None:
    undone = Executed(10.0, FIRST, Outcome.INFEASIBLE.value, True, 0.0)
    assert outcomes([seen(FIRST, 10.0), seen(FIRST, 20.0)], undone, ended(60.0)) == ["merge"]


def test_a_row_says_what_was_predicted_and_what_came_of_it() -> None:
    (row,) = merge_rows([seen(FIRST, 10.0)], [judged(12.0), ended(12.0, "COLLISION")])
    assert row == {
        "time": 10.0,
        "speed": 5.0,
        "neighbours": 0,
        "action": "mergeleft",
        "to": "a_1/1",
        "scores": {"tmpud": 0.5},
        "unsafe": True,
        "outcome": "collide",
    }


def test_tasks_are_told_apart_and_each_drive_has_its_own_town() -> None:
    tasks = [*town_tasks(25, 60_000, "millbrook"), *local_tasks(250, 60_000)]
    assert len({task.key for task in tasks}) == len(tasks) == 2 * 25 + 4 * 3
    assert len({json.dumps(task.shared) for task in tasks if task.shared}) == 2 * 25
    assert [task.digest for task in tasks[:2]] != [tasks[0].digest] * 2


def eager_drive(seconds: float) -> ScriptedWorld:
    """Drive a road of five segments from end to end eagerly, in a world in which every merge is said to be unsafe."""
    roads, goal = network([road("a", 2, 300.0)], []), request("a_0/0", "a_0/4")
    cost, domain = driven(roads), Domain(roads, goal)
    world = ScriptedWorld(cost, lambda *_: 0.0, {}, seconds)
    mind = Deliberation(goal, domain, AspPlanner(roads, TMPUD), Paths(cost=cost), world)
    list(run_tmpud(domain.start_state(), mind, Eager()))
    return world


@pytest.mark.parametrize(("seconds", "merges"), [(WATCHED, 4), (WATCHED / 10, 2)])
def test_an_eager_drive_merges_where_the_last_merge_had_its_time(seconds: float, merges: int) -> None:
    """The plan has no merge; after one the plan has one back."""
    world = eager_drive(seconds)
    assert [step.action.is_merge for step in world.driven].count(True) == merges
    assert world.driven[-1].next_state.segment == "a_0/4"


def test_an_eager_drive_asks_about_every_merge_and_drives_it_whatever_the_answer() -> None:
    world = eager_drive(WATCHED)
    assert world.asked == world.driven


def test_local_merges_become_rows_that_can_be_repeated_and_kept_as_json() -> None:
    work = LocalMergeScenes()
    arguments = {"condition": "high density, high acceleration", "seed": 3, "merges": 12, "presets": ["tmpud"]}
    work.prepare({})
    first, again = (work.run(None, arguments) for _ in range(2))
    assert json.loads(json.dumps(first, allow_nan=False)) == again
    assert len(first["merges"]) == 12
    assert {row["outcome"] for row in first["merges"]} <= {"merge", "collide", "stop"}
    assert len({row["scores"]["gap"] for row in first["merges"]}) > 6
