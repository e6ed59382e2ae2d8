"""Two made runs: the first gives plan A up for plan B and drives straight on, the other keeps plan A and merges."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.made_runs import LONGER, MERGE_LATER, MERGE_NOW, SAFE, START, events, header, merging, recorded
from tests.viewer.test_replay import document_in
from tmpud.errors import RequestError
from tmpud.events import Event, Executed, Finished, Header
from tmpud.presets import TMPUD
from tmpud.task.utility import penalty
from tmpud.viewer.comparison import comparison_document
from tmpud.viewer.intact import read_intact
from tmpud.viewer.replay import write_comparison, write_replay


@pytest.fixture
def compared(tmp_path: Path) -> Any:
    return compare(tmp_path, events(), merging())


def compare(tmp_path: Path, *logs: Iterable[Event]) -> Any:
    runs = [read_intact(recorded(tmp_path / f"run{number}", log)) for number, log in enumerate(logs)]
    return comparison_document(*runs)


def test_they_part_where_their_actions_first_differ_with_what_either_knew(compared: Any) -> None:
    assert compared["names"] == ["tmpud", "no-com"]
    assert compared["notices"] == []
    parted = compared["parted"]
    assert parted["alike"] == 0
    tmpud, nocom = parted["sides"]
    assert (tmpud["action"], nocom["action"]) == ("forward", "mergeleft")
    assert (tmpud["plan"], nocom["plan"]) == ("B", "A")
    assert tmpud["time"] == nocom["time"] == 1000 * START
    assert (tmpud["road"], nocom["road"]) == pytest.approx((300.0 + LONGER, 300.0))
    assert tmpud["safe"] == [None, [SAFE, pytest.approx(penalty(SAFE, TMPUD), abs=1e-3)]]
    assert nocom["safe"] == [None, None]


def test_only_what_is_left_of_a_plan_counts_where_they_part_later(tmp_path: Path) -> None:
    later = Executed(15.0, MERGE_LATER[1], "done", True, 90.0), Executed(15.0, MERGE_NOW[1], "done", True, 90.0)
    first, second = ([*without_end(events()), step] for step in later)
    tmpud, other = compare(tmp_path, first, second)["parted"]["sides"]
    assert tmpud["road"] == pytest.approx((300.0 + LONGER) * 2 / 3, abs=1e-3)
    assert tmpud["time"] == 14_000
    assert other["safe"] == [None, None]


def without_end(log: Iterable[Event]) -> list[Event]:
    return [event for event in log if not isinstance(event, Finished)]


def test_a_run_that_stops_earlier_parts_from_one_that_goes_on(tmp_path: Path) -> None:
    longer = [*without_end(events()), Executed(15.0, MERGE_LATER[1], "done", True, 90.0)]
    parted = compare(tmp_path, events(), longer)["parted"]
    assert (parted["alike"], parted["sides"][0], parted["sides"][1]["action"]) == (1, None, "forward")


def test_the_same_actions_part_nowhere_and_what_nothing_came_of_is_no_action(tmp_path: Path) -> None:
    barred = [events()[0], *events()[1:3], Executed(START, MERGE_NOW[0], "infeasible", False, 0.0), *events()[3:]]
    assert compare(tmp_path, events(), barred)["parted"] is None


@pytest.mark.parametrize(
    ("mission", "told"),
    [
        ({"seed": 2}, "seed: 1 and 2, so the traffic is not the same"),
        ({"traffic": 9}, "traffic: 2 and 9, so there are more vehicles in one"),
        ({"goal": "high4n"}, "goal: park2e_1 and high4n, so the roads driven are not the same"),
        ({"via": ["high4n"]}, "via: none and high4n, so the roads driven are not the same"),
        ({"settings": {}}, "the presets of one name differ in their settings"),
    ],
)
def test_what_else_differs_is_said(tmp_path: Path, mission: dict[str, Any], told: str) -> None:
    assert compare(tmp_path, events(), events(**mission))["notices"] == [told]


def test_other_versions_are_named(tmp_path: Path) -> None:
    newer = replace(header(), versions={"tmpud": "1"})
    assert compare(tmp_path, events(), [newer, *events()[1:]])["notices"] == ["other versions of tmpud"]


@pytest.mark.parametrize(
    ("mission", "names"),
    [
        ({"algorithm": "threshold"}, ["tmpud", "threshold(0.3)"]),
        ({"preset": "paper"}, ["tmpud, preset tmpud", "tmpud, preset paper"]),
        ({"seed": 2}, ["tmpud, seed 1", "tmpud, seed 2"]),
        ({}, ["tmpud (first)", "tmpud (second)"]),
    ],
)
def test_names_tell_the_runs_apart(tmp_path: Path, mission: dict[str, Any], names: list[str]) -> None:
    assert compare(tmp_path, events(), events(**mission))["names"] == names


def test_runs_of_two_maps_are_refused_in_one_line(tmp_path: Path) -> None:
    elsewhere: Header = replace(header(), map={"name": "at\nlantis", "digest": "0" * 64})
    with pytest.raises(RequestError, match=r"the same map.*millbrook.*at\\nlantis") as caught:
        compare(tmp_path, events(), [elsewhere, *events()[1:]])
    assert "\n" not in str(caught.value)


def test_a_run_without_readable_settings_is_compared_without_penalties(tmp_path: Path) -> None:
    tmpud, _ = compare(tmp_path, events(settings={}), merging())["parted"]["sides"]
    assert tmpud["safe"] == [None, [SAFE, None]]


def test_the_page_holds_the_roads_once(tmp_path: Path) -> None:
    one, other = recorded(tmp_path / "a", events()), recorded(tmp_path / "b", merging())
    assert write_comparison(one, other, tmp_path / "pair.html") == []
    write_replay(one, tmp_path / "one.html")
    page = (tmp_path / "pair.html").read_text(encoding="utf-8")
    first, second = document_in(page)["runs"]
    assert first["ground"]["lanes"]
    assert second["ground"] is None
    assert len(page) < 1.2 * (tmp_path / "one.html").stat().st_size


def test_what_is_missing_is_said_of_which_run(tmp_path: Path) -> None:
    whole, cut = recorded(tmp_path / "whole"), recorded(tmp_path / "cut", without_end(merging()))
    (told,) = write_comparison(whole, cut, tmp_path / "pair.html")
    assert told.startswith(f"{cut}: the run has no end")
