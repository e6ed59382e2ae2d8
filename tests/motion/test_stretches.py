"""Lane changes where the road marks allow them on parts of a lane only."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.task.tiny_roads import network, road
from tmpud.motion.mapping import RoadPoint, StateMapping
from tmpud.motion.path import Change
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import PAPER, TMPUD, Preset
from tmpud.roads.moves import SHORTEST_MERGE, moves, moves_into
from tmpud.roads.network import RoadNetwork, Stretch
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition

numbers = st.lists(st.floats(0, 400), min_size=2, max_size=8, unique=True).map(sorted)
rows = numbers.map(lambda row: tuple(Stretch(*pair) for pair in zip(row[::2], row[1::2], strict=False)))


def two_lanes(open_left: tuple[Stretch, ...], length: float, segment_length: float) -> RoadNetwork:
    right, left = road("a", 2, length)
    return network([[replace(right, change_left=open_left), left]], [], segment_length)


@pytest.mark.parametrize("preset", [TMPUD, PAPER], ids=["cut", "uncut"])
@given(open_left=rows, length=st.floats(50, 400), share=st.floats(1 / 3, 2 / 3))
def test_every_merge_that_is_offered_is_driven_within_an_open_stretch(
    preset: Preset, open_left: tuple[Stretch, ...], length: float, share: float
) -> None:
    town = two_lanes(open_left, length, preset.segment_length)
    first, *_, last = town.segments
    request = ServiceRequest(Place("start", (first,)), (Place("goal", (last,)),))
    planner = PathPlanner(town, StateMapping(town, request, TMPUD))
    for segment in town.segments_of("a_0"):
        for move in moves(town, segment.id):
            if not move.action.is_merge:
                continue
            step = Transition(State(segment.id, 0), move.action, State(move.segment, 0))
            here = RoadPoint("a_0", segment.start + share * (segment.end - segment.start))
            driven = planner.moves(here, step)
            assert driven is not None
            (change,) = (each for each in driven if isinstance(each, Change))
            assert change.end - change.start >= SHORTEST_MERGE - 1e-9
            assert any(start <= change.start and change.end <= end + 1e-9 for start, end in open_left)


@given(open_left=rows, length=st.floats(50, 400))
def test_merges_lead_back_to_where_they_are_offered(open_left: tuple[Stretch, ...], length: float) -> None:
    town = two_lanes(open_left, length, 60.0)
    onward = {(here, move.action, move.segment) for here in town.segments for move in moves(town, here)}
    back = {(move.segment, move.action, there) for there in town.segments for move in moves_into(town, there)}
    assert onward == back


def test_a_merge_waits_until_the_mark_may_be_crossed() -> None:
    town = two_lanes((Stretch(50.0, 80.0),), 120.0, 60.0)
    (move,) = (move for move in moves(town, "a_0/0") if move.action is Action.MERGELEFT)
    assert move.segment == "a_1/1"
    assert town.open_from("a_0", Action.MERGELEFT, 10.0, 20.0) == Stretch(50.0, 80.0)
    assert town.open_from("a_0", Action.MERGELEFT, 55.0, 20.0) == Stretch(55.0, 80.0)
    assert town.open_from("a_0", Action.MERGELEFT, 65.0, 20.0) is None
    assert town.open_from("a_1", Action.MERGERIGHT, 65.0, 20.0) == Stretch(65.0, math.inf)
