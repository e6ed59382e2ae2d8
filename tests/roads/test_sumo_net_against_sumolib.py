"""The nets that come with SUMO, the shipped towns and CARLA's, compared with what SUMO's own library reads."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import SHARED_MAPS
from tmpud.errors import MapError
from tmpud.roads import read_sumo_net, shipped_towns
from tmpud.roads.loading import map_file
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.symbols import Action

sumo = pytest.importorskip("sumo")
sumolib = pytest.importorskip("sumolib")

WITH_SUMO = sorted(Path(sumo.__path__[0]).rglob("*.net.xml*"))
WITHOUT_CARS = {"rail", "rail_demo", "racing"}  # trains, and a race track for the class "vip"
NETS = [path for path in WITH_SUMO if path.parent.name not in WITHOUT_CARS]
NETS += sorted(SHARED_MAPS.glob("*.net.xml")) + [map_file(town) for town in shipped_towns()]
ACTIONS = {
    "s": Action.FORWARD,
    "l": Action.TURNLEFT,
    "L": Action.TURNLEFT,
    "r": Action.TURNRIGHT,
    "R": Action.TURNRIGHT,
}


@pytest.fixture(scope="module", params=NETS, ids=lambda path: f"{path.parent.name}/{path.name}")
def nets(request: pytest.FixtureRequest) -> tuple[RoadNetwork, Any]:
    """Return one net as we read it and as sumolib does."""
    theirs = sumolib.net.readNet(str(request.param), withInternal=True, withPedestrianConnections=True)
    return read_sumo_net(request.param), theirs


def is_road(lane: Any) -> bool:
    return bool(lane.getEdge().getFunction() == "" and lane.allows("passenger"))


def connections(theirs: Any) -> dict[tuple[str, str], Any]:
    """Return sumolib's connections that cars may use, by the lanes they join."""
    lanes = [lane for edge in theirs.getEdges(withInternal=False) for lane in edge.getLanes() if is_road(lane)]
    return {
        (lane.getID(), out.getToLane().getID()): out
        for lane in lanes
        for out in lane.getOutgoing()
        if is_road(out.getToLane()) and out.getDirection() != "t" and "passenger" in out._allowed
    }


def test_the_same_lanes_are_open_to_cars_with_the_same_length_limit_and_width(nets: tuple[RoadNetwork, Any]) -> None:
    ours, theirs = nets
    lanes = [lane for edge in theirs.getEdges() for lane in edge.getLanes() if is_road(lane)]
    assert ours.lanes.keys() == {lane.getID() for lane in lanes}
    for lane in lanes:
        mine = ours.lanes[lane.getID()]
        assert mine.length == pytest.approx(sumolib.geomhelper.polyLength(lane.getShape()), abs=1e-6)
        assert (mine.edge, mine.index, mine.speed) == (lane.getEdge().getID(), lane.getIndex(), lane.getSpeed())
        assert mine.width == lane.getWidth()


def test_the_same_connections_with_the_same_direction_and_light(nets: tuple[RoadNetwork, Any]) -> None:
    ours, theirs = nets
    expected = connections(theirs)
    assert {(c.from_lane, c.to_lane) for c in ours.connections} == expected.keys()
    for mine in ours.connections:
        other = expected[mine.from_lane, mine.to_lane]
        assert mine.action is ACTIONS[other.getDirection()]
        assert (mine.signal or "", mine.link) == (other.getTLSID(), other.getTLLinkIndex())
        assert (mine.internal_lanes or ("",))[0] == other.getViaLaneID()


def test_the_same_connections_are_foes_and_give_way(nets: tuple[RoadNetwork, Any]) -> None:
    ours, theirs = nets
    expected = connections(theirs)
    by_node: dict[str, list[int]] = {}
    for index, mine in enumerate(ours.connections):
        by_node.setdefault(mine.junction, []).append(index)
    for node_id, group in by_node.items():
        node = theirs.getNode(node_id)
        number = {i: node.getLinkIndex(expected[ends(ours.connections[i])]) for i in group}
        for one, other in product(group, group):
            if number[one] in node._foes and number[other] in node._foes:
                assert (other in ours.connections[one].foes) == node.areFoes(number[one], number[other])
                yields = node._prohibits[number[one]][-number[other] - 1] == "1"
                assert (other in ours.connections[one].yields_to) == yields


def ends(connection: LaneConnection) -> tuple[str, str]:
    return connection.from_lane, connection.to_lane


def test_paths_run_from_lane_to_lane_without_turning_back(nets: tuple[RoadNetwork, Any]) -> None:
    ours, _ = nets
    for connection in ours.connections:
        start, end = ours.lanes[connection.from_lane].centre, ours.lanes[connection.to_lane].centre
        assert connection.path.points[0] == start.points[-1]
        assert connection.path.points[-1] == end.points[0] or connection.path.length <= 0.1 + 1e-9
        for a, b, c in zip(
            connection.path.points, connection.path.points[1:], connection.path.points[2:], strict=False
        ):
            back = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0
            assert not (back and min(math.dist(a, b), math.dist(b, c)) < 0.5)


@pytest.mark.parametrize(
    "path", [p for p in WITH_SUMO if p.parent.name in WITHOUT_CARS], ids=lambda path: str(path.parent.name)
)
def test_a_net_without_roads_for_cars_is_refused(path: Path) -> None:
    with pytest.raises(MapError, match="no lane that is open to cars"):
        read_sumo_net(path)
