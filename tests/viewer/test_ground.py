import math
from itertools import accumulate

from hypothesis import given
from hypothesis import strategies as st

from tmpud.roads.loading import load_map
from tmpud.viewer.ground import ground, line

MILLBROOK = load_map("millbrook")
metres = st.floats(-1e5, 1e5, allow_nan=False)


@given(st.lists(st.tuples(metres, metres), max_size=8))
def test_a_line_is_kept_to_the_centimetre(points: list[tuple[float, float]]) -> None:
    packed = line(points)
    found = list(zip(accumulate(packed[::2]), accumulate(packed[1::2]), strict=True))
    assert found == [(round(x * 100), round(y * 100)) for x, y in points]


def test_all_lanes_and_all_lights_are_there() -> None:
    drawn = ground(MILLBROOK)
    assert len(drawn["lanes"]) == len(MILLBROOK.lanes)
    controlled = {(way.signal, way.link) for way in MILLBROOK.connections if way.signal is not None}
    assert {(light, link) for light, links, *_ in drawn["stops"] for link in links} == controlled


def test_the_pieces_of_a_stop_line_lie_side_by_side_across_the_lanes_end() -> None:
    lane = next(lane for lane in MILLBROOK.lanes.values() if len({w.action for w in MILLBROOK.outgoing(lane.id)}) == 2)
    ends = [[value / 100 for value in stop[2:]] for stop in ground(MILLBROOK)["stops"]]
    x, y, _ = lane.centre.pose_at(lane.length - 0.4)
    mine = [e for e in ends if min(math.dist(e[:2], (x, y)), math.dist(e[2:], (x, y))) < lane.width * 0.51]
    pieces = [e for e in mine if math.dist(e[:2], e[2:]) < lane.width * 0.6]
    assert len(pieces) == 2
    assert pieces[0][2:] == pieces[1][:2]
    assert math.isclose(math.dist(pieces[0][:2], pieces[1][2:]), lane.width, abs_tol=0.05)


def test_each_lane_names_its_road_and_each_road_its_street() -> None:
    drawn = ground(MILLBROOK)
    names = dict(drawn["edges"])
    assert {name: drawn["edges"][edge][0] for name, edge, *_ in drawn["lanes"]} == {
        lane.id: lane.edge for lane in MILLBROOK.lanes.values()
    }
    assert (names["park1e"], names["avenue3w"]) == ("Park Street", "The Avenue")
