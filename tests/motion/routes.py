"""Routes on the crossroads of the judging tests."""

from tests.judging.roads import crossroads
from tmpud.motion.path import Cross, Follow
from tmpud.motion.route import Route, build_route

ROADS = crossroads()
WAY = ROADS.outgoing("in_0")[0]


def straight() -> Route:
    """Return the route along in_0, through the junction and along out_0."""
    lanes = ROADS.lanes
    moves = (Follow(lanes["in_0"], 0.0, 100.0), Cross(WAY), Follow(lanes["out_0"], 0.0, 100.0))
    return build_route(ROADS, moves, ())


def turn_left() -> Route:
    way = next(way for way in ROADS.outgoing("in_1") if way.to_lane == "north_0")
    lanes = ROADS.lanes
    return build_route(ROADS, (Follow(lanes["in_1"], 50.0, 100.0), Cross(way), Follow(lanes["north_0"], 0.0, 50.0)), ())


ROUTE = straight()
