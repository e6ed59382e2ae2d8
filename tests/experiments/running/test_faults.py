"""Samples of what ``make verify`` does at length."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.experiments.running.damages import DAMAGES, damage
from tests.experiments.running.faults import misbehave
from tests.experiments.running.kills import Plan, placed_plans, random_plans, strike
from tests.experiments.running.strikes import fill_disk, full_plans, interrupt, interrupt_plans, meet, meeting_plans

SEED = 2


@pytest.mark.parametrize("plan", [*random_plans(10, SEED), *placed_plans(10, SEED)], ids=str)
def test_a_killed_campaign_ends_like_one_that_was_not(plan: Plan) -> None:
    found = strike(plan)
    assert found.struck
    assert found.sound, found


@pytest.mark.parametrize("plan", interrupt_plans(5, SEED), ids=str)
def test_an_interrupted_campaign_stops_at_once_and_ends_like_one_that_was_not(plan: Plan) -> None:
    found = interrupt(plan)
    assert found.sound, found
    assert found.seconds < 3.0


def test_a_campaign_out_of_disk_says_so_and_ends_like_one_that_was_not() -> None:
    for plan in full_plans(3, SEED):
        found = fill_disk(plan)
        assert found.struck
        assert found.sound, found


@pytest.mark.parametrize("plan", meeting_plans(2), ids=str)
def test_a_second_supervisor_is_refused_and_a_dead_one_is_replaced(plan: Plan) -> None:
    found = meet(plan)
    assert found.struck, found
    assert found.sound, found


def test_no_damaged_line_counts_and_each_is_named(tmp_path: Path) -> None:
    tally = damage(10 * len(DAMAGES), SEED, tmp_path)
    assert tally.damaged_lines > 100
    assert not tally.notes


def test_tasks_that_misbehave_cost_themselves_only() -> None:
    tally = misbehave(10, SEED)
    assert (tally.bad, tally.good, tally.wrong_status, tally.harmed, tally.left) == (10, 10, 0, 0, 0), tally
