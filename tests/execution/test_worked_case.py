"""The worked case in SUMO: two areas to merge in before a left turn, and slow cars beside the first one."""

from functools import cache
from pathlib import Path

import pytest

from tests.simulators.crowded import Neighbour, among
from tmpud.events import Estimated, Event, Executed, Finished, Judged, Planned, Refused
from tmpud.runner import Mission, drive

SLOW = tuple(Neighbour("a_1", ahead, 3.0, 3.0) for ahead in (-6.0, 3.0, 12.0))
ALGORITHMS = ("tmpud", "threshold", "no-com")


@cache
def driven(net: Path, algorithm: str, cars: tuple[Neighbour, ...] = SLOW) -> tuple[Event, ...]:
    mission = Mission(map=str(net), start="a_0", goal="goal", traffic=0, algorithm=algorithm)
    return tuple(drive(mission, simulator=among(*cars), frames=False))


def executed(events: tuple[Event, ...]) -> list[tuple[str, str]]:
    return [(e.step.action.value, e.step.state.segment) for e in events if isinstance(e, Executed)]


def finished(events: tuple[Event, ...]) -> Finished:
    assert isinstance(events[-1], Finished)
    return events[-1]


@pytest.mark.parametrize("algorithm", ["tmpud", "threshold"])
def test_area_1_is_refused_for_the_cars_beside_it_and_area_2_taken(blocks_net: Path, algorithm: str) -> None:
    events = driven(blocks_net, algorithm)
    (refused,) = [event for event in events if isinstance(event, Refused)]
    assert refused.step.state.segment == "a_0/0"
    assert executed(events)[2] == ("mergeleft", "b_0/0")
    assert finished(events).status == "SUCCESS"
    assert not any(isinstance(event, Judged) for event in events)


def test_the_estimate_names_one_of_the_cars_beside_the_ego(blocks_net: Path) -> None:
    first = next(event for event in driven(blocks_net, "tmpud") if isinstance(event, Estimated))
    assert set(first.ids) <= {"beside0", "beside1", "beside2"}
    assert first.worst in first.ids
    assert first.safe < 0.3


def test_area_2_costs_no_extra_distance(blocks_net: Path) -> None:
    events, alone = driven(blocks_net, "tmpud"), driven(blocks_net, "tmpud", ())
    assert executed(alone)[0] == ("mergeleft", "a_0/0")
    assert finished(events).distance == pytest.approx(finished(alone).distance, abs=0.5)
    plan_a, plan_b = (event for event in events if isinstance(event, Planned))
    assert plan_a.cost_m == pytest.approx(plan_b.cost_m, abs=0.01)


def test_the_distance_driven_is_the_plans_own_length(blocks_net: Path) -> None:
    events = driven(blocks_net, "tmpud", ())
    plan = next(event for event in events if isinstance(event, Planned))
    assert finished(events).distance == pytest.approx(plan.cost_m, rel=0.01)


def test_no_com_forces_area_1_and_collides(blocks_net: Path) -> None:
    events = driven(blocks_net, "no-com")
    assert not any(isinstance(event, Estimated | Refused) for event in events)
    assert executed(events) == [("mergeleft", "a_0/0")]
    (collision,) = [event for event in events if isinstance(event, Judged) and event.kind == "collision"]
    assert collision.blame == "ego"
    assert (finished(events).status, finished(events).metrics["collisions"]) == ("COLLISION", 1)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_without_cars_all_algorithms_drive_plan_a_without_a_word_from_the_judge(
    blocks_net: Path, algorithm: str
) -> None:
    events = driven(blocks_net, algorithm, ())
    assert executed(events)[0] == ("mergeleft", "a_0/0")
    assert finished(events).status == "SUCCESS"
    assert not any(isinstance(event, Judged) for event in events)
    assert all(event.safe == 1.0 for event in events if isinstance(event, Estimated))


def test_the_same_mission_gives_the_same_events_twice_in_one_process(blocks_net: Path) -> None:
    again = driven.__wrapped__(blocks_net, "tmpud", SLOW)
    assert again == driven(blocks_net, "tmpud")
