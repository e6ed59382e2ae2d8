import math
from collections import Counter
from collections.abc import Iterator

import pytest

from tests.execution.scripted import AREA_1, DRIVE_ON, HOME, TO_GOAL
from tests.task.tiny_roads import driven, two_blocks
from tmpud.events import Event, Executed, Judged
from tmpud.execution.abstract import COLLIDE, MERGE, STOP, AbstractWorld, JointSample
from tmpud.execution.baselines import communication
from tmpud.execution.deliberation import Deliberation
from tmpud.execution.tmpud import run_tmpud
from tmpud.presets import TMPUD
from tmpud.scene import Outcome
from tmpud.symbols import Transition
from tmpud.task.domain import Domain
from tmpud.task.search_planner import SearchPlanner

TOWN = two_blocks(100.0)
LENGTH = driven(TOWN)
TELLING = JointSample((0.0, 0.25, 1.0), (COLLIDE, STOP, MERGE))  # Safe tells the outcome
PAIRS = dict(zip(TELLING.safe, TELLING.outcome, strict=True))
ENDS = {COLLIDE: Outcome.COLLIDE, STOP: Outcome.DONE, MERGE: Outcome.DONE}


class Lengths:
    def path_length(self, transition: Transition) -> float:
        return LENGTH[transition]


def world(trial: str, sample: JointSample = TELLING) -> AbstractWorld:
    return AbstractWorld(LENGTH.__getitem__, sample, trial)


def executed(here: AbstractWorld, step: Transition) -> tuple[Outcome, list[Event]]:
    events: list[Event] = []

    def pass_on() -> Iterator[Event]:
        return (yield from here.execute(step, ()))  # type: ignore[return-value]

    run = pass_on()
    while True:
        try:
            events.append(next(run))
        except StopIteration as end:
            return end.value, events


def test_the_estimate_and_the_outcome_of_a_merge_are_one_learning_run() -> None:
    for trial in range(300):
        here = world(f"{trial}")
        outcome = PAIRS[here.estimate(AREA_1).safe]
        end, events = executed(here, AREA_1)
        assert end is ENDS[outcome]
        assert (here.collisions, here.stops) == (outcome == COLLIDE, outcome == STOP)
        kinds = [event.kind for event in events if isinstance(event, Judged)]
        assert kinds == {COLLIDE: ["collision"], STOP: ["forced_stop"], MERGE: []}[outcome]


def test_a_draw_depends_on_trial_transition_and_visit_and_on_nothing_else() -> None:
    other = Transition(AREA_1.state._replace(segment="b_0/0"), AREA_1.action, AREA_1.next_state)
    drawn = {}
    for trial in range(200):
        here, again = world(f"{trial}"), world(f"{trial}")
        again.estimate(other)
        assert here.estimate(AREA_1).safe == again.estimate(AREA_1).safe
        drawn[trial] = here.estimate(AREA_1).safe, here.estimate(other).safe
    assert len(set(drawn.values())) == 9  # all pairs of the three values: the two transitions are independent


def test_asking_again_before_the_ego_has_moved_rolls_no_new_dice_but_coming_back_does() -> None:
    changed = 0
    for trial in range(100):
        here = world(f"{trial}")
        first = here.estimate(AREA_1).safe
        assert [here.estimate(AREA_1).safe for _ in range(5)] == [first] * 5
        executed(here, DRIVE_ON)
        changed += here.estimate(AREA_1).safe != first
    assert 45 <= changed <= 90  # two in three are to be expected


def test_an_estimate_counts_until_the_ego_moves() -> None:
    here = world("0")
    assert not here.is_estimated(DRIVE_ON)
    here.estimate(DRIVE_ON)
    assert here.is_estimated(DRIVE_ON)
    executed(here, DRIVE_ON)
    assert not here.is_estimated(DRIVE_ON)


def test_the_outcomes_come_as_often_as_they_were_learnt() -> None:
    sample = JointSample((0.5,) * 10, (COLLIDE,) * 2 + (STOP,) + (MERGE,) * 7)
    n, counts = 20_000, Counter[str]()
    for trial in range(n):
        counts[sample.draw(f"{trial}")[1]] += 1
    for outcome, share in ((COLLIDE, 0.2), (STOP, 0.1), (MERGE, 0.7)):
        assert abs(counts[outcome] / n - share) < 4 * math.sqrt(share * (1 - share) / n)


def test_other_actions_are_safe_and_everything_costs_its_length() -> None:
    here = world("0", JointSample((0.0,), (MERGE,)))
    assert here.estimate(DRIVE_ON).safe == 1.0
    assert here.estimate(AREA_1).safe == 0.0
    executed(here, DRIVE_ON)
    executed(here, AREA_1)
    assert here.distance == LENGTH[DRIVE_ON] + LENGTH[AREA_1]
    assert here.time == pytest.approx(here.distance / (20 / 3.6))


def test_what_has_no_path_is_not_driven() -> None:
    here = AbstractWorld(lambda _: math.inf, TELLING, "0")
    assert executed(here, AREA_1) == (Outcome.INFEASIBLE, [])
    assert (here.distance, here.collisions, here.stops) == (0.0, 0, 0)


def test_a_drive_without_end_is_given_up() -> None:
    here = AbstractWorld(lambda _: 20_000.0, TELLING, "0")
    assert executed(here, DRIVE_ON)[0] is Outcome.TIME_LIMIT


def test_sample_needs_as_many_outcomes_as_values() -> None:
    for safe, outcome in (((), ()), ((1.0,), (MERGE, STOP))):
        with pytest.raises(ValueError, match="do not go with"):
            JointSample(safe, outcome)


@pytest.mark.parametrize("algorithm", ["tmpud", "no-com", "threshold"])
def test_all_algorithms_meet_the_same_traffic_at_the_same_place(algorithm: str) -> None:
    domain = Domain(TOWN, TO_GOAL)
    for trial in range(50):
        here = world(f"{trial}")
        first = PAIRS[world(f"{trial}").estimate(AREA_1).safe]
        mind = Deliberation(TO_GOAL, domain, SearchPlanner(TOWN, TMPUD), Lengths(), here)
        events = list(run_tmpud(HOME, mind, communication(algorithm, 0.3)))
        steps = [event.step for event in events if isinstance(event, Executed)]
        if algorithm == "no-com":
            assert (steps[0], steps == [AREA_1]) == (AREA_1, first == COLLIDE)
        elif first != MERGE:
            assert AREA_1 not in steps
        else:
            assert steps[0] == AREA_1
