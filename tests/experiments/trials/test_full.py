from tmpud.events import Estimated, Executed, Finished, Judged
from tmpud.experiments.trials.full import summary
from tmpud.symbols import Action, State, Transition

MERGE = Transition(State("a", 0), Action.MERGELEFT, State("b", 0))
ON = Transition(State("b", 0), Action.FORWARD, State("c", 0))


def finished(status: str = "SUCCESS", stops: int = 0, **measured: float) -> Finished:
    metrics = {"collisions": int(status == "COLLISION"), "forced_stops": stops, "violations": 0, **measured}
    return Finished(9.0, status, "", 123.4, 20.0, 1, metrics)


def judged(kind: str, rule: str) -> Judged:
    return Judged(3.0, kind, "car1", rule, "ego", "")


def estimated(safe: float) -> Estimated:
    return Estimated(1.0, MERGE, safe, None, safe, (), (), ())


def test_a_merge_that_nobody_asked_about_has_no_safe_value() -> None:
    found = summary([Executed(2.0, MERGE, "done", False, 50.0), Executed(3.0, ON, "done", False, 90.0), finished()])
    assert found["merges"] == [None]
    assert (found["unsafe"], found["risky_merges"]) == (False, 0)


def test_a_merge_driven_against_a_low_estimate_is_risky() -> None:
    found = summary([estimated(0.4), Executed(2.0, MERGE, "done", True, 50.0), finished()])
    assert (found["merges"], found["risky_merges"]) == ([0.4], 1)


def test_a_collision_of_a_merge_is_unsafe_and_one_of_another_class_is_not() -> None:
    assert summary([judged("collision", "merge"), finished("COLLISION")])["unsafe"]
    other = summary([judged("collision", "rear-end"), finished("COLLISION")])
    assert (other["unsafe"], other["collisions"]) == (False, {"rear-end": 1})


def test_a_forced_stop_is_unsafe_and_hard_braking_is_only_recorded() -> None:
    assert summary([judged("forced_stop", "merge"), finished(stops=1)])["unsafe"]
    braked = summary([judged("hard_braking", "merge"), finished()])
    assert (braked["unsafe"], braked["hard_brakings"]) == (False, 1)


def test_what_was_measured_is_kept_and_what_was_not_is_none() -> None:
    found = summary([finished(min_ttc=2.5, rms_jerk=0.75)])
    assert (found["min_ttc"], found["rms_jerk"], found["max_jerk"]) == (2.5, 0.75, None)
