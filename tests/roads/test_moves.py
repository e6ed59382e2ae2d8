from __future__ import annotations

from pathlib import Path

import networkx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.roads.nets import CROSSING
from tmpud.roads import read_sumo_net
from tmpud.roads.moves import Move, largest_strong_part, moves, reachable, strong_parts
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action


@pytest.fixture
def crossing(tmp_path: Path) -> RoadNetwork:
    path = tmp_path / "tiny.net.xml"
    path.write_text(CROSSING)
    return read_sumo_net(path)


def test_a_merge_leads_to_the_neighbouring_lane_of_the_next_segment(crossing: RoadNetwork) -> None:
    assert list(moves(crossing, "out_0/0")) == [Move(Action.FORWARD, "out_0/1"), Move(Action.MERGELEFT, "out_1/1")]


def test_the_last_segment_of_a_road_offers_only_its_ways_through_the_junction(crossing: RoadNetwork) -> None:
    assert list(moves(crossing, "in_2/1")) == [Move(Action.TURNLEFT, "north_0/0")]
    assert list(moves(crossing, "out_0/2")) == []


def test_a_merge_needs_permission_and_twenty_metres(crossing: RoadNetwork, tmp_path: Path) -> None:
    assert [move.action for move in moves(crossing, "in_2/0")] == [Action.FORWARD]
    finely_cut = read_sumo_net(tmp_path / "tiny.net.xml", segment_length=15.0)
    assert [move.action for move in moves(finely_cut, "out_0/0")] == [Action.FORWARD]


def test_what_is_reachable_from_a_turning_lane_is_the_road_it_turns_into(crossing: RoadNetwork) -> None:
    assert reachable(crossing, ["in_2/0"]) == {"in_2/0", "in_2/1", "north_0/0"}


def test_a_net_without_circles_has_strong_parts_of_one_segment(crossing: RoadNetwork) -> None:
    assert len(largest_strong_part(crossing)) == 1


@given(st.integers(1, 12).flatmap(lambda n: st.lists(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)))))
def test_strong_parts_are_those_of_networkx(pairs: list[tuple[int, int]]) -> None:
    graph: dict[str, list[str]] = {str(node): [] for pair in pairs for node in pair}
    for start, end in pairs:
        graph[str(start)].append(str(end))
    expected = {frozenset(part) for part in networkx.strongly_connected_components(networkx.DiGraph(graph))}
    assert set(strong_parts(graph)) == expected
