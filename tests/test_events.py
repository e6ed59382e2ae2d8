import json
import math
from dataclasses import fields

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.errors import RunFileError
from tmpud.events import (
    SCHEMA_VERSION,
    Estimated,
    Event,
    Executed,
    Finished,
    Frame,
    Header,
    Judged,
    Planned,
    Refused,
    from_json,
    to_json,
)
from tmpud.symbols import Action, State, Transition

KINDS = (Header, Planned, Estimated, Refused, Executed, Frame, Judged, Finished)

number = st.floats(-1e6, 1e6, allow_nan=False).map(lambda value: round(value, 6))
significant = st.floats(allow_nan=False, allow_infinity=False).map(lambda value: float(f"{value:.6g}"))
whole = st.integers(-(2**31), 2**31)
text = st.text(max_size=12)
state = st.builds(State, text, st.integers(0, 3))
step = st.builds(Transition, state, st.sampled_from(Action), state)
plan = st.lists(step, max_size=3).map(tuple)
row = st.tuples(whole, whole, whole, whole)
plain = st.dictionaries(text, st.one_of(number, text, st.booleans(), st.none(), whole), max_size=3)


def several(strategy: st.SearchStrategy[object], most: int = 3) -> st.SearchStrategy[tuple[object, ...]]:
    return st.lists(strategy, max_size=most).map(tuple)


EVENTS = st.one_of(
    st.builds(Header, number, st.dictionaries(text, text, max_size=3), plain, plain),
    st.builds(
        Planned, number, whole, plan, several(number), several(number), several(st.tuples(plan, number, number)), text
    ),
    st.builds(
        Estimated, number, step, number, st.one_of(st.none(), text), number, several(text), several(several(number)),
        several(st.tuples(number, number, number, number)), several(st.tuples(number, number, number, number, number)),
        several(several(st.none() | st.tuples(significant, significant, significant))),
    ),
    st.builds(Refused, number, step, number, text),
    st.builds(Executed, number, step, text, st.booleans(), number),
    st.builds(Frame, number, row, several(text), several(row), st.dictionaries(text, text, max_size=3)),
    st.builds(Judged, number, text, st.one_of(st.none(), text), text, text, text),
    st.builds(Finished, number, text, text, number, number, whole, st.dictionaries(text, number, max_size=3)),
)  # fmt: skip


@given(EVENTS)
def test_every_event_comes_back_from_its_json_line(event: Event) -> None:
    line = json.dumps(to_json(event), allow_nan=False)
    back = from_json(json.loads(line))
    assert back == event
    assert type(back) is type(event)


def test_there_is_an_example_of_every_kind_of_event() -> None:
    assert {kind.__name__ for kind in KINDS} == {kind.__name__ for kind in Event.__subclasses__()}
    for kind in KINDS:
        assert {field.name for field in fields(kind)} >= {"time"}


def test_a_transition_is_written_as_one_row() -> None:
    step = Transition(State("a_0/0", 0), Action.MERGELEFT, State("a_1/1", 1))
    assert to_json(Refused(1.5, step, 0.25, "why")) == {
        "event": "Refused",
        "time": 1.5,
        "step": ["a_0/0", 0, "mergeleft", "a_1/1", 1],
        "safe": 0.25,
        "reason": "why",
    }


def test_an_estimate_of_schema_1_is_read_without_what_it_was_made_of() -> None:
    row = {
        "event": "Estimated", "time": 1.0, "step": ["a", 0, "forward", "b", 0], "safe": 0.5, "worst": "car1",
        "min_t": 0.5, "ids": ["car1"], "o": [[0.5]], "trajectory": [[0.0, 1.0, 2.0, 0.0]],
    }  # fmt: skip
    event = from_json(row)
    assert isinstance(event, Estimated)
    assert (event.others, event.planes) == ((), ())
    assert to_json(event) == {**row, "others": [], "planes": []}


def test_a_half_plane_keeps_six_digits_however_small_and_no_control_at_all_is_a_limit_of_minus_infinity() -> None:
    planes = (((-math.inf, 0.0, 0.0), None, (1.23456789e-9, 123456.789, -0.5)),)
    event = Estimated(
        0.0, Transition(State("a", 0), Action.FORWARD, State("b", 0)), 0.0, None, 0.0, (), (), (), (), planes
    )
    line = json.dumps(to_json(event), allow_nan=False)
    assert json.loads(line)["planes"] == [[["-inf", 0.0, 0.0], None, [1.23457e-9, 123457.0, -0.5]]]
    back = from_json(json.loads(line))
    assert isinstance(back, Estimated)
    assert back.planes == (((-math.inf, 0.0, 0.0), None, (1.23457e-9, 123457.0, -0.5)),)
    assert to_json(back) == to_json(event)


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_a_number_that_is_not_finite_is_written_as_a_string(value: float) -> None:
    event = Finished(0.0, "SUCCESS", "", value, 0.0, 0, {"ttc": value})
    line = json.dumps(to_json(event), allow_nan=False)
    assert json.loads(line)["distance"] == str(value)


def test_no_event_holds_a_wall_clock_time() -> None:
    assert not any("wall" in field.name or field.name in ("date", "ms") for kind in KINDS for field in fields(kind))


@pytest.mark.parametrize(
    "row",
    [
        {},
        {"event": "Nonsense", "time": 0.0},
        {"event": "Refused", "time": 0.0},
        {"event": "Refused", "time": 0.0, "step": ["a", 0], "safe": 1.0, "reason": ""},
        {"event": "Refused", "time": 0.0, "step": ["a", 0, "fly", "b", 0], "safe": 1.0, "reason": ""},
        {"event": "Refused", "time": 0.0, "step": None, "safe": 1.0, "reason": ""},
        {"event": "Finished", "time": 0.0, "status": "", "surprise": 1},
        {"event": ["Refused"]},
    ],
)
def test_a_row_that_is_no_event_is_refused(row: dict[str, object]) -> None:
    with pytest.raises(RunFileError, match=f"not an event of schema {SCHEMA_VERSION}"):
        from_json(row)


@pytest.mark.parametrize("row", [[], 3, None, "Frame"])
def test_json_that_is_no_object_is_refused(row: object) -> None:
    with pytest.raises(RunFileError, match=f"not an event of schema {SCHEMA_VERSION}"):
        from_json(row)  # type: ignore[arg-type]
