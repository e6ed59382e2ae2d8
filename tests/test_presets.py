import math
from dataclasses import replace
from typing import Any

import pytest

from tmpud.errors import RequestError
from tmpud.presets import PAPER, TMPUD, preset_named


def test_a_name_gives_the_preset_itself() -> None:
    assert preset_named("paper") is PAPER


def test_a_changed_preset_differs_in_the_named_fields_only() -> None:
    changed = preset_named("tmpud:gamma=1500,acceleration=-4/2,horizon=none,constant_term=true,segment_length=inf")
    assert changed.name == "tmpud:gamma=1500,acceleration=-4/2,horizon=none,constant_term=true,segment_length=inf"
    assert (changed.gamma, changed.acceleration, changed.horizon) == (1500.0, (-4.0, 2.0), None)
    assert (changed.constant_term, changed.segment_length) == (True, math.inf)
    assert changed.interval == TMPUD.interval


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("fast", "there are tmpud, paper, released"),
        ("tmpud:speed=3", "'speed' is no field; there are gamma"),
        ("tmpud:gamma=much", "gamma=much"),
        ("tmpud:gamma", "gamma"),
        ("tmpud:share=guessed", "'exact' or 'sampled'"),
        ("tmpud:acceleration=1", "acceleration=1"),
        ("tmpud:name=x", "'name' is no field"),
        ("tmpud:horizon=-3", "horizon is -3.0, and must be none, or finite and not negative"),
        ("tmpud:turning_range=-1.6/1.6", "within a right angle"),
    ],
)
def test_what_is_no_preset_is_refused_in_one_line(text: str, said: str) -> None:
    with pytest.raises(RequestError, match="preset") as caught:
        preset_named(text)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("field", ["gamma", "safety_distance", "closing_weight", "margin", "gate", "gate_rate"])
@pytest.mark.parametrize("value", [math.nan, -math.inf])
def test_constants_by_which_nothing_could_be_judged_are_refused(field: str, value: float) -> None:
    changed: dict[str, Any] = {field: value}
    if field.startswith("gate") and value == -math.inf:
        assert getattr(replace(TMPUD, **changed), field) == value  # the gate that is always open
    else:
        with pytest.raises(ValueError, match=f"{field} is {value}, and must be"):
            replace(TMPUD, **changed)


@pytest.mark.parametrize(
    "changed",
    [
        {"turning_range": (0.1, 0.1)},
        {"turning_range": (-1.6, 1.6)},
        {"acceleration": (3.0, -6.0)},
        {"acceleration": (-math.inf, 3.0)},
        {"samples": 0},
        {"interval": 0.0},
        {"sensing_range": math.nan},
        {"ego_speeds": (0.0,)},
        {"segment_length": -1.0},
    ],
    ids=str,
)
def test_values_that_make_no_sense_are_refused(changed: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match="must be"):
        replace(TMPUD, **changed)
    assert replace(TMPUD, turning="yaw rate", turning_range=(-1.6, 1.6)).turning_range == (-1.6, 1.6)
