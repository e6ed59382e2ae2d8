from dataclasses import replace

import pytest

from tests.execution.scripted import (
    AREA_1,
    AREA_2,
    DRIVE_ON,
    HOME,
    PLAN_A,
    PLAN_B,
    actions,
    run,
)
from tests.task.tiny_roads import link, network, request, road, two_blocks
from tmpud.errors import NoPlanError, RequestError
from tmpud.execution.baselines import ALGORITHMS, communication
from tmpud.presets import RELEASED, TMPUD
from tmpud.scene import Outcome
from tmpud.symbols import Action, State, Transition

ONLY_AREA = Transition(HOME, Action.MERGELEFT, State("a_1/1", 1))
NEVER = replace(TMPUD, safe_expires=None)


def test_no_com_never_estimates_and_drives_plan_a_whatever_it_meets() -> None:
    drive = run({AREA_1: 0.0}, algorithm="no-com")
    assert drive.world.asked == []
    assert actions(drive.world.driven) == PLAN_A
    assert not any(event.estimated for event in drive.executed)
    assert drive.mind.replans == 0


def test_no_com_ends_with_the_collision_it_drives_into() -> None:
    assert run(algorithm="no-com", outcomes={AREA_1: Outcome.COLLIDE}).outcome is Outcome.COLLIDE


@pytest.mark.parametrize("beta", [0.0, 0.1, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("safe", [0.0, 0.1, 0.2999, 0.3, 0.5, 1.0])
def test_threshold_refuses_exactly_what_is_less_safe_than_beta(beta: float, safe: float) -> None:
    drive = run({AREA_1: safe}, algorithm="threshold", beta=beta)
    assert drive.refused == ([AREA_1] if safe < beta else [])
    assert actions(drive.world.driven) == (PLAN_B if safe < beta else PLAN_A)
    assert drive.outcome is Outcome.DONE


def test_threshold_goes_round_the_block_however_long_it_is() -> None:
    drive = run({AREA_1: 0.2, AREA_2: 0.2}, algorithm="threshold", preset=NEVER, roads=two_blocks(400.0))
    assert [step.state.segment[0] for step in drive.world.driven if step.action is Action.TURNRIGHT] == list("cde")
    assert drive.refused == [AREA_1, AREA_2]
    assert drive.outcome is Outcome.DONE


def test_with_no_other_plan_threshold_holds_its_lane_and_ends_where_the_lane_does() -> None:
    roads = network([road("a", 2, 100.0)], [])
    with pytest.raises(NoPlanError, match="goal a_1/1 is cut off from a_0/1"):
        run({ONLY_AREA: 0.0}, algorithm="threshold", roads=roads, goal=request("a_0/0", "a_1/1"))


def test_holding_its_lane_threshold_comes_to_the_next_area_and_merges_when_it_is_safe() -> None:
    ring = network([road("a", 2, 100.0)], [link("a_0", "a_0")])
    drive = run(
        lambda step, times: 0.0 if step == ONLY_AREA and times == 0 else 1.0,
        algorithm="threshold",
        roads=ring,
        goal=request("a_0/0", "a_1/1"),
        seconds=31.0,
    )
    assert actions(drive.world.driven) == "forward forward mergeleft"
    assert drive.refused == [ONLY_AREA]
    assert drive.outcome is Outcome.DONE


def test_a_lane_is_held_though_driving_on_is_unsafe_too() -> None:
    ring = network([road("a", 2, 100.0)], [link("a_0", "a_0")])
    drive = run(
        lambda step, times: 0.0 if step == DRIVE_ON or (step == ONLY_AREA and times == 0) else 1.0,
        algorithm="threshold",
        roads=ring,
        goal=request("a_0/0", "a_1/1"),
        seconds=31.0,
    )
    assert drive.world.driven[0] == DRIVE_ON
    assert drive.world.driven[-1] == ONLY_AREA
    assert drive.outcome is Outcome.DONE


def test_with_no_other_plan_the_released_preset_forces_the_merge() -> None:
    drive = run(
        {ONLY_AREA: 0.0},
        algorithm="threshold",
        preset=replace(RELEASED, segment_length=60.0),
        roads=network([road("a", 2, 100.0)], []),
        goal=request("a_0/0", "a_1/1"),
    )
    assert drive.world.driven == [ONLY_AREA]
    assert drive.refused == []
    assert drive.outcome is Outcome.DONE


def test_algorithms_go_by_their_names() -> None:
    for name in ALGORITHMS:
        assert callable(communication(name, 0.3))
    with pytest.raises(RequestError, match="no algorithm is called 'thresold'; there are tmpud, no-com, threshold"):
        communication("thresold", 0.3)


# The worked case ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("algorithm", "beta"), [("tmpud", 0.0), ("threshold", 0.1), ("threshold", 0.5)])
def test_in_the_worked_case_area_1_is_refused_and_area_2_taken_at_no_extra_distance(
    algorithm: str, beta: float
) -> None:
    unhindered, drive = run(), run({AREA_1: 0.0}, algorithm=algorithm, beta=beta)
    assert drive.refused == [AREA_1]
    assert drive.world.driven[2] == AREA_2
    assert drive.world.distance == unhindered.world.distance


def test_in_the_worked_case_no_com_forces_area_1() -> None:
    assert run({AREA_1: 0.0}, algorithm="no-com").world.driven[0] == AREA_1
