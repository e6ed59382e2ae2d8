import re
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.viewer.made_runs import LONGER, MERGE_LATER, MERGE_NOW, SAFE, START, decision, planned
from tmpud.events import Estimated, Executed, Planned, Refused
from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
from tmpud.task.utility import penalty
from tmpud.viewer.changes import changes
from tmpud.viewer.memory import Memory
from tmpud.viewer.reasons import Candidate, Change

RISK = penalty(SAFE, TMPUD)  # [m]


def explained() -> Change:
    (change,) = changes(decision(), TMPUD)
    return change


def role(change: Change, wanted: str) -> Candidate:
    (found,) = (candidate for candidate in change.candidates if candidate.role == wanted)
    return found


def test_a_change_names_the_action_its_safe_and_the_vehicle() -> None:
    change = explained()
    assert (change.number, change.step) == (1, MERGE_NOW[0])
    words = " ".join(change.words)
    assert all(part in words for part in ("Plan A", "plan B", "merge left", "park1e_0", "Safe = 0.50", "car1"))


def test_the_road_has_the_name_that_people_use_where_it_has_one() -> None:
    (change,) = changes(decision(), TMPUD, {"park1e_0": "Park Street"}.__getitem__)
    assert change.words[0] == "Plan A was to merge left now, on Park Street."
    assert explained().words[0] == "Plan A was to merge left now, on park1e_0."


def test_both_plans_stand_in_the_table_with_their_terms_before_and_after() -> None:
    old, new = role(explained(), "given up"), role(explained(), "chosen")
    assert (old.plan, new.plan) == (MERGE_NOW, MERGE_LATER)
    assert (old.before, old.after) == pytest.approx((0.0, RISK))
    assert (new.before, new.after) == (0.0, 0.0)
    assert (old.total, new.total) == pytest.approx((300.0 + RISK, 300.0 + LONGER))
    assert explained().candidates[0] == new


def test_what_would_have_kept_the_old_plan_would_indeed_have_kept_it() -> None:
    safer, longer = explained().keep
    (least,) = map(float, re.findall(r"at least (0\.\d+)", safer))
    assert penalty(least, TMPUD) == pytest.approx(LONGER, abs=0.01 * TMPUD.gamma / 4)
    assert penalty(SAFE, TMPUD) > LONGER
    assert f"at least {RISK - LONGER:,.0f} m longer" in longer


@given(st.floats(0.0, 1.0), st.sampled_from([TMPUD, PAPER, RELEASED]))
def test_the_least_safe_undoes_the_penalty(safe: float, preset: Preset) -> None:
    memory = Memory(preset)
    assert memory.least_safe(penalty(safe, memory.preset)) == pytest.approx(safe, abs=1e-9)


def test_no_safe_is_enough_where_even_safe_1_costs_too_much() -> None:
    assert Memory(TMPUD).least_safe(-1.0) is None
    assert Memory(TMPUD).least_safe(1e9) == 0.0


def test_an_estimate_is_forgotten_when_the_run_forgets_it() -> None:
    memory = Memory(TMPUD)
    estimate = next(event for event in decision() if isinstance(event, Estimated))
    memory.note_estimate(estimate)
    assert memory.penalty(MERGE_NOW, START + 30.0) == pytest.approx(RISK)
    assert memory.penalty(MERGE_NOW, START + 30.1) == 0.0


def test_a_threshold_bars_the_action_so_that_nothing_but_its_rule_would_have_kept_the_plan() -> None:
    refused = Refused(START, MERGE_NOW[0], SAFE, "Safe(mergeleft) = 0.50 < 0.6")
    log = [
        replace(event, reason=refused.reason) if isinstance(event, Planned) and event.reason != "start" else event
        for event in decision()
    ]
    (change,) = changes([refused if isinstance(event, Refused) else event for event in log], TMPUD)
    assert role(change, "given up").after is None
    assert change.keep == ()
    assert "0.50 < 0.6" in " ".join(change.words)


def test_only_what_is_left_of_the_old_plan_is_compared() -> None:
    driven = Executed(START + 5, MERGE_LATER[0], "done", True, 100.0)
    new = planned(START + 5, MERGE_LATER[1:][::-1], 90.0, {}, "forward cannot be driven from here")
    *_, change = changes([*decision(), driven, new], TMPUD)
    assert role(change, "given up").plan == MERGE_LATER[1:]
    assert role(change, "given up").after is None
    assert change.step is None
    assert "cannot be driven" in " ".join(change.words)
