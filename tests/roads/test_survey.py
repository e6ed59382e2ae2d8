from __future__ import annotations

from tmpud.roads import load_map
from tmpud.roads.survey import survey
from tmpud.symbols import Action


def test_a_survey_counts_what_the_map_has() -> None:
    network = load_map("millbrook")
    found = survey(network)
    assert (found.junctions, found.signals, found.edges) == (16, 13, 52)
    assert found.lane_km > 14
    assert found.connections == len(network.connections)
    assert found.unreachable == 0


def test_transitions_through_junctions_are_the_connections_and_the_rest_lies_on_roads() -> None:
    network = load_map("millbrook")
    found = survey(network).transitions
    turns = sum(connection.action is Action.TURNLEFT for connection in network.connections)
    straight = sum(connection.action is Action.FORWARD for connection in network.connections)
    assert found[Action.TURNLEFT] == turns
    assert found[Action.FORWARD] == straight + len(network.segments) - len(network.lanes)
    assert found[Action.MERGELEFT] == found[Action.MERGERIGHT] > 0
