import pytest

from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Planned, Refused
from tmpud.story import Story, actions, closing, plan_name, summarise
from tmpud.symbols import Action, State, Transition

MERGE = Transition(State("a_0/0", 0), Action.MERGELEFT, State("a_1/1", 0))
ON = Transition(State("a_0/0", 0), Action.FORWARD, State("a_0/1", 0))
LATE = Transition(State("a_0/1", 0), Action.MERGELEFT, State("a_1/2", 0))
MISSION = {
    "start": "a_0", "goal": "goal", "via": ["b"], "algorithm": "threshold", "beta": 0.3,
    "preset": "tmpud", "traffic": 12, "seed": 3,
}  # fmt: skip

EVENTS: tuple[Event, ...] = (
    Header(0.0, {}, {"name": "town"}, MISSION),
    Planned(60.0, 0, (MERGE,), (50.0,), (0.0,), (((ON, LATE), 50.0, 0.0),), "start"),
    Estimated(60.0, MERGE, 0.1234567, "car3", 0.0, ("car3",), ((0.1,),), ((0.0, 0.0, 0.0, 0.0),)),
    Refused(60.0, MERGE, 0.12, "Safe(mergeleft) = 0.12"),
    Planned(60.0, 0, (ON, LATE), (25.0, 25.0), (0.0, 10.5), (), "Safe(mergeleft) = 0.12"),
    Frame(60.1, (0, 0, 0, 0), (), (), {}),
    Executed(70.0, ON, "done", False, 25.4),
    Judged(75.0, "forced stop", "car3", "merge", "ego", "stopped"),
    Finished(80.0, "SUCCESS", "", 50.456, 20.0, 1, {"collisions": 0, "forced_stops": 1, "violations": 0}),
)


def told(event: Event) -> str:
    return "\n".join(Story().tell(event))


def test_the_story_names_plans_in_their_order() -> None:
    story = Story()
    lines = [line for event in EVENTS for line in story.tell(event)]
    assert lines[:2] == ["town: a_0 -> b -> goal", "threshold(0.3), preset tmpud, 12 vehicles, seed 3"]
    assert any("plan A    50 m + 0 m safety penalty" in line for line in lines)
    assert any("plan B    50 m + 10 m safety penalty (because Safe(mergeleft) = 0.12)" in line for line in lines)
    assert lines[-1] == "   80.0 s  SUCCESS"


def test_every_event_but_a_frame_is_told_with_its_time() -> None:
    for event in EVENTS[1:]:
        lines = Story().tell(event)
        assert bool(lines) is not isinstance(event, Frame)
        assert all(line.startswith(f"{event.time:7.1f} s  ") for line in lines)


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (2, "estimate  mergeleft a_0/0 -> a_1/1: Safe = 0.12  (nearest risk car3)"),
        (3, "refused   mergeleft a_0/0 -> a_1/1: Safe(mergeleft) = 0.12"),
        (6, "drove     forward a_0/0 -> a_0/1: done, 25 m so far"),
        (7, "JUDGED    forced stop car3 (blame: ego) stopped"),
    ],
)
def test_it_says_what_was_estimated_refused_driven_and_judged(number: int, words: str) -> None:
    assert words in told(EVENTS[number])


def test_an_end_with_a_message_is_told_with_it() -> None:
    assert told(Finished(1.0, "NO_PLAN", "cut off", 0.0, 0.0, 0)).endswith("NO_PLAN: cut off")


def test_repeated_actions_are_counted() -> None:
    assert actions((ON, ON, MERGE, ON)) == "forward x2, mergeleft, forward"
    assert actions(()) == "nothing to do"


def test_plans_have_names_for_ever() -> None:
    names = [plan_name(i) for i in range(1000)]
    assert names[:3] == ["A", "B", "C"]
    assert names[25:28] == ["Z", "A1", "B1"]
    assert len(set(names)) == 1000


def test_the_summary_holds_every_plan_and_estimate_and_how_it_ended() -> None:
    summary = summarise(EVENTS)
    assert summary["schema_version"] == 1
    assert (summary["status"], summary["seed"], summary["replans"]) == ("SUCCESS", 3, 1)
    assert (summary["distance_m"], summary["travel_time_s"]) == (50.46, 20.0)
    assert (summary["collisions"], summary["forced_stops"]) == (0, 1)
    assert summary["plans"] == [
        {"actions": ["mergeleft"], "cost_m": 50.0, "penalty_m": 0.0},
        {"actions": ["forward", "mergeleft"], "cost_m": 50.0, "penalty_m": 10.5},
    ]
    assert summary["estimates"] == [{"action": "mergeleft", "lane": "a_0", "safe": 0.123457}]
    assert [row["vehicle"] for row in summary["judged"]] == ["car3"]


def test_the_table_at_the_end_shows_what_was_measured_and_leaves_out_what_was_not() -> None:
    measured = {"min_ttc": 2.345, "rms_jerk": 0.91, "max_jerk": 6.0}
    summary = summarise(EVENTS) | {"latency_ms": {}}
    table = "\n".join(closing(summary | measured))
    for words in ("at least 2.3 s", "root mean square 0.9 m/s^3, max 6.0 m/s^3"):
        assert words in table
    assert not any("at least" in line or "jerk" in line for line in closing(summary))


def test_the_table_at_the_end_shows_counts_and_latencies() -> None:
    latency = {"plan": {"n": 3, "median": 1.5, "max": 2.25}}
    table = "\n".join(closing(summarise(EVENTS) | {"latency_ms": latency}))
    for words in ("SUCCESS", "50 m", "20 s", "median 1.50 ms, max 2.25 ms, n = 3"):
        assert words in table
