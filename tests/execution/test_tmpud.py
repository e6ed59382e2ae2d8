import math
from dataclasses import replace

import pytest

from tests.execution.scripted import (
    AREA_1,
    AREA_2,
    DRIVE_ON,
    HOME,
    PLAN_A,
    PLAN_B,
    TO_GOAL,
    actions,
    run,
)
from tests.task.tiny_roads import driven, network, request, road, two_blocks
from tmpud.errors import NoPlanError
from tmpud.events import Estimated, Planned
from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Outcome
from tmpud.symbols import Action, State, Transition
from tmpud.task.domain import Domain
from tmpud.task.utility import penalty


def test_an_unchanged_plan_is_driven_action_by_action() -> None:
    drive = run()
    assert drive.outcome is Outcome.DONE
    assert actions(drive.world.driven) == PLAN_A
    assert drive.plans == [PLAN_A]
    assert drive.mind.replans == 0


def test_each_action_is_executed_with_the_rest_of_the_plan() -> None:
    drive = run()
    assert [len(upcoming) for upcoming in drive.world.upcoming] == [3, 2, 1, 0]
    assert drive.world.upcoming[0] == tuple(drive.world.driven[1:])


def test_every_first_action_is_estimated_once_for_the_snapshot_in_which_it_begins() -> None:
    drive = run()
    assert drive.world.asked == drive.world.driven
    assert [type(event).__name__ for event in drive.events] == ["Planned", *["Estimated", "Executed"] * 4]
    assert all(event.estimated for event in drive.executed)


def test_a_low_safe_changes_plan_a_to_plan_b_and_the_refused_action_is_not_driven() -> None:
    drive = run({AREA_1: 0.0})
    assert drive.plans == [PLAN_A, PLAN_B]
    assert actions(drive.world.driven) == PLAN_B
    assert AREA_1 not in drive.world.driven
    assert drive.refused == [AREA_1]
    assert drive.mind.replans == 1
    assert drive.outcome is Outcome.DONE


def test_plan_b_is_driven_at_no_extra_distance() -> None:
    assert run({AREA_1: 0.0}).world.distance == run().world.distance


def test_two_unsafe_areas_send_it_round_the_block() -> None:
    drive = run({AREA_1: 0.0, AREA_2: 0.0}, preset=replace(TMPUD, safe_expires=None))
    assert drive.plans[:2] == [PLAN_A, PLAN_B]
    assert [step.state.segment[0] for step in drive.world.driven] == list("aabbccddeeff")
    assert drive.outcome is Outcome.DONE


def test_an_unsafe_action_with_no_better_plan_is_executed() -> None:
    drive = run({AREA_1: 0.0, AREA_2: 0.0}, roads=two_blocks(300.0))
    assert drive.world.driven[0] == DRIVE_ON
    assert AREA_2 in drive.world.driven
    assert drive.outcome is Outcome.DONE


def test_the_plan_is_told_with_what_each_of_its_actions_costs() -> None:
    first, second = (event for event in run({AREA_1: 0.0}).events if isinstance(event, Planned))
    assert first.reason == "start"
    assert second.reason == "Safe(mergeleft) = 0.00"
    assert sum(first.penalty) == sum(second.penalty) == 0.0
    assert len(first.cost) == len(first.plan) == 4
    assert first.cost_m == pytest.approx(second.cost_m)
    (others,) = [other for other in second.alternatives if actions(other[0]) == PLAN_A]
    assert others[2] == pytest.approx(penalty(0.0, TMPUD), abs=0.01)


def test_it_is_done_at_once_where_the_start_is_the_goal() -> None:
    drive = run(goal=request("a_0/0", "a_0/0"))
    assert drive.outcome is Outcome.DONE
    assert drive.plans == [""]
    assert drive.world.driven == drive.world.asked == []


@pytest.mark.parametrize("outcome", [Outcome.COLLIDE, Outcome.BLOCKED, Outcome.TIME_LIMIT, Outcome.INVALID])
def test_a_collision_or_a_limit_ends_the_drive(outcome: Outcome) -> None:
    drive = run(outcomes={AREA_1: outcome})
    assert drive.outcome is outcome
    assert drive.world.driven == [AREA_1]
    assert drive.executed[-1].outcome == outcome.value


def test_an_infeasible_action_is_forbidden_and_the_plan_made_anew() -> None:
    drive = run(outcomes={AREA_1: Outcome.INFEASIBLE})
    assert drive.mind.known.cost[AREA_1] == math.inf
    assert actions(drive.world.driven) == f"mergeleft {PLAN_B}"
    assert drive.outcome is Outcome.DONE
    replanned = drive.of(Planned)[1]
    assert isinstance(replanned, Planned)
    assert replanned.reason == "mergeleft cannot be driven from here"


def test_an_action_without_a_path_is_neither_estimated_nor_planned_again() -> None:
    roads = two_blocks(100.0)
    length = {**_lengths(roads), AREA_1: math.inf}
    drive = run(length=length, outcomes={AREA_1: Outcome.INFEASIBLE})
    assert AREA_1 not in drive.world.asked
    assert not drive.executed[0].estimated
    assert actions(drive.world.driven[1:]) == PLAN_B


def test_no_plan_is_raised_where_nothing_leads_to_the_goal() -> None:
    roads = network([road("a", 1, 100.0), road("goal")], [])
    with pytest.raises(NoPlanError, match=r"goal goal_0/0 is cut off from a_0/0"):
        run(roads=roads)


def test_no_plan_is_raised_where_the_last_way_turns_out_to_be_infeasible() -> None:
    roads = network([road("a", 2, 100.0)], [])
    merge = Transition(HOME, AREA_1.action, State("a_1/1", 1))
    with pytest.raises(NoPlanError, match="forbidden: mergeleft from a_0/0 to a_1/1"):
        run(roads=roads, goal=request("a_0/0", "a_1/1"), outcomes={merge: Outcome.INFEASIBLE})


# Livelock and hysteresis -------------------------------------------------------------------------------------------


def sinking(step: Transition, times: int) -> float:
    """Say of the merge and of driving on, in turns, that they are worse than thought."""
    if step not in (AREA_1, DRIVE_ON):
        return 1.0
    return 0.9 - 0.2 * times - 0.1 * (step == DRIVE_ON)


@pytest.mark.parametrize("max_replans", [1, 2, 3, 4])
def test_the_plan_changes_at_most_max_replans_times_without_motion(max_replans: int) -> None:
    drive = run(sinking, preset=replace(TMPUD, max_replans=max_replans))
    before = drive.events[: drive.events.index(drive.executed[0])]
    assert sum(isinstance(event, Planned) for event in before) == max_replans + 1
    assert len(drive.refused) == drive.mind.replans == max_replans
    assert drive.outcome is Outcome.DONE


@pytest.mark.parametrize("max_replans", [1, 2, 3, 4])
def test_after_that_the_most_conservative_plan_is_driven(max_replans: int) -> None:
    drive = run(sinking, preset=replace(TMPUD, max_replans=max_replans))
    last_believed: dict[Transition, float] = {AREA_1: 1.0, DRIVE_ON: 1.0}
    refusals = 0
    for event in drive.events:
        if isinstance(event, Estimated):
            last_believed[event.step] = event.safe
            refusals += 1
        if refusals == max_replans:
            break
    assert drive.world.driven[0] == max(last_believed, key=lambda step: last_believed[step])


def test_a_refused_action_is_not_driven_in_the_same_snapshot() -> None:
    for max_replans in range(1, 6):
        drive = run(sinking, preset=replace(TMPUD, max_replans=max_replans))
        told = drive.events[: drive.events.index(drive.executed[0])]
        assert drive.refused
        assert isinstance(told[-1], Estimated)
        assert told[-1].step == drive.executed[0].step


def test_hysteresis_keeps_the_old_plan_on_a_tie() -> None:
    drive = run({AREA_1: 1.0, DRIVE_ON: 1.0})
    assert drive.plans == [PLAN_A]


def test_hysteresis_keeps_the_old_plan_against_one_that_is_better_by_less_than_a_centimetre() -> None:
    roads = two_blocks(100.0)
    cost = _lengths(roads)
    for more, plans in ((0.0099, [PLAN_A]), (0.02, [PLAN_A, PLAN_B])):
        assert run(roads=roads, length={**cost, AREA_1: cost[AREA_1] + more}).plans == plans


def _lengths(roads: RoadNetwork) -> dict[Transition, float]:
    """Return the length of every transition on the two blocks."""
    domain, cost = Domain(roads, TO_GOAL), driven(roads)
    found, ahead = dict[Transition, float](), [HOME]
    while ahead:
        for step in domain.successors(ahead.pop()):
            if step not in found:
                found[step] = cost[step]
                ahead.append(step.next_state)
    return found


# What a preset says of estimates -----------------------------------------------------------------------------------


def test_the_released_preset_estimates_merges_only() -> None:
    drive = run(preset=replace(RELEASED, segment_length=60.0))
    assert drive.world.asked == [AREA_1]
    assert [event.estimated for event in drive.executed] == [True, False, False, False]


@pytest.mark.parametrize(("preset", "expires"), [(TMPUD, True), (PAPER, False)])
def test_safe_expires_as_the_preset_says(preset: Preset, expires: bool) -> None:
    drive = run({AREA_1: 0.5}, preset=replace(preset, segment_length=60.0), seconds=31.0)
    assert (AREA_1 in drive.mind.known.safe) is not expires


@pytest.mark.parametrize("preset", [TMPUD, PAPER])
def test_the_most_conservative_plan_risks_least_whatever_each_action_pays(preset: Preset) -> None:
    mind = run(preset=preset).mind
    on = Transition(DRIVE_ON.next_state, Action.FORWARD, State("b_0/0", 0))
    mind.known.safe[AREA_1] = 0.0
    assert mind.most_conservative([(AREA_1,), (DRIVE_ON, on, AREA_2)]) == (DRIVE_ON, on, AREA_2)
    mind.known.cost[on] = math.inf
    assert mind.most_conservative([(AREA_1,), (DRIVE_ON, on, AREA_2)]) == (AREA_1,), "the other cannot be driven"
