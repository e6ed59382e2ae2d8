from __future__ import annotations

from pathlib import Path

import pytest

from tests.roads.opendrive.crossroads import crossroads
from tmpud.errors import MapError
from tmpud.roads.opendrive.facts import Road, read_facts


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ('revMajor="1"', 'revMajor="2"', "revMajor='2' is not a version"),
        ("header", "heading", "the header is missing"),
        ('length="185.000000"', 'length="nan"', "length='nan' is not a number"),
        ('length="185.000000"', 'length="1e7"', "not that of a road"),
        ('id="2" junction', 'id="1" junction', "used by two roads"),
        ("<line/>", "<line/><line/>", "it is not one of: arc line"),
        ('<laneSection s="100.0">', '<laneSection s="300.0">', "do not follow one another"),
        ('junction="-1"', 'rule="LHT" junction="-1"', "left-hand traffic"),
        ('unit="mph"', 'unit="knots"', "unit='knots' is not one of"),
        ('laneChange="both"', 'laneChange="maybe"', "laneChange='maybe' is not one of"),
        ('<signalReference id="60"', '<signalReference id="61"', "'61' is no signal of this map"),
        ('curvature="', 'curvature="inf', "is not a number"),
    ],
)
def test_nonsense_is_refused_with_its_line(old: str, new: str, cause: str, tmp_path: Path) -> None:
    assert old in crossroads()
    file = tmp_path / "town.xodr"
    file.write_text(crossroads().replace(old, new))
    with pytest.raises(MapError, match=cause) as caught:
        read_facts(file)
    assert caught.value.line is not None


def test_controllers_and_priorities_are_their_junctions(tmp_path: Path) -> None:
    file = tmp_path / "town.xodr"
    file.write_text(
        crossroads().replace('<junction id="200" name="">', '<junction id="200"><priority high="7" low="8"/>')
    )
    facts = read_facts(file)
    assert facts.controllers["100"] == (frozenset("12"), frozenset("34"))
    assert facts.controllers["200"] == ()
    assert facts.priorities["200"] == {(7, 8)}


def test_a_lane_keeps_to_the_lowest_limit_on_its_way() -> None:
    road = Road(100.0, (0.0, 50.0), ((0.0, 20.0), (30.0, 10.0), (60.0, 15.0)), {(1, -1): 5.0}, {})
    assert (road.limit(0, -1), road.limit(1, -2), road.limit(1, -1)) == (10.0, 10.0, 5.0)


def test_a_border_may_be_crossed_as_its_marks_say() -> None:
    marks = {(0, -1): ((10.0, "none"), (20.0, "increase"), (30.0, "both"))}
    road = Road(100.0, (0.0, 50.0), (), {}, marks)
    assert list(road.crossable(0, -1, "increase")) == [(0.0, 10.0), (20.0, 30.0), (30.0, 50.0)]
    assert list(road.crossable(0, -1, "decrease")) == [(0.0, 10.0), (30.0, 50.0)]
    assert list(road.crossable(1, -1, "decrease")) == [(50.0, 100.0)]
