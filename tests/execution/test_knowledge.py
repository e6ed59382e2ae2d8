import math
from dataclasses import replace

import pytest

from tests.execution.scripted import AREA_1, AREA_2
from tmpud.execution.knowledge import Knowledge
from tmpud.presets import PAPER, PRESETS, RELEASED, TMPUD, Preset

FIRST = 50.0  # [m] from f(s)


def knowledge(preset: Preset) -> Knowledge:
    return Knowledge(lambda _: FIRST, preset)


@pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)
def test_cost_is_the_path_length_and_safe_is_one_until_something_is_learnt(preset: Preset) -> None:
    known = knowledge(preset)
    assert (known.cost[AREA_1], known.safe[AREA_1]) == (FIRST, 1.0)
    assert AREA_1 not in known.safe


@pytest.mark.parametrize(
    ("preset", "length", "cost"),
    [
        (TMPUD, 40.0, FIRST),
        (TMPUD, 60.0, 60.0),
        (PAPER, 40.0, 40.0),
        (PAPER, 60.0, 60.0),
        (RELEASED, 40.0, FIRST),
        (RELEASED, 60.0, FIRST),
    ],
)
def test_cost_in_flight_is_floored_follows_the_pose_or_never_changes(
    preset: Preset, length: float, cost: float
) -> None:
    known = knowledge(preset)
    known.learn(AREA_1, 0.4, length, now=0.0)
    assert known.cost[AREA_1] == cost
    assert known.safe[AREA_1] == 0.4


@pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)
def test_what_cannot_be_driven_costs_infinitely_much_whatever_the_preset(preset: Preset) -> None:
    known = knowledge(preset)
    known.learn(AREA_1, 0.4, math.inf, now=0.0)
    known.forbid(AREA_2, 0.1, now=0.0)
    assert known.cost[AREA_1] == known.cost[AREA_2] == math.inf
    assert known.safe[AREA_2] == 0.1


def test_what_was_learnt_is_forgotten_after_its_time_and_not_before() -> None:
    known = knowledge(replace(TMPUD, safe_expires=30.0))
    known.learn(AREA_1, 0.4, 60.0, now=5.0)
    known.forbid(AREA_2, 0.1, now=6.0)
    known.forget(35.0)
    assert (known.safe[AREA_1], known.cost[AREA_1]) == (0.4, 60.0)
    known.forget(35.01)
    assert AREA_1 not in known.safe
    assert (known.cost[AREA_1], known.cost[AREA_2]) == (FIRST, math.inf)
    known.forget(36.01)
    assert (known.safe[AREA_2], known.cost[AREA_2]) == (1.0, FIRST)


def test_a_second_look_renews_what_is_known() -> None:
    known = knowledge(TMPUD)
    known.learn(AREA_1, 0.4, FIRST, now=0.0)
    known.learn(AREA_1, 0.6, FIRST, now=29.0)
    known.forget(40.0)
    assert known.safe[AREA_1] == 0.6


@pytest.mark.parametrize("preset", [PAPER, RELEASED], ids=lambda preset: preset.name)
def test_the_paper_and_the_released_code_never_forget(preset: Preset) -> None:
    known = knowledge(preset)
    known.learn(AREA_1, 0.4, FIRST, now=0.0)
    known.forget(1e9)
    assert known.safe[AREA_1] == 0.4
