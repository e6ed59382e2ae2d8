import math

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
    ],
)
def test_what_is_no_preset_is_refused_in_one_line(text: str, said: str) -> None:
    with pytest.raises(RequestError, match="preset") as caught:
        preset_named(text)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
