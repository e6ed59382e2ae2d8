"""Small road networks made by hand or at random."""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import replace

from tmpud.geometry import Polyline
from tmpud.roads.network import NOWHERE, WHOLE, Lane, LaneConnection, RoadNetwork, Stretch
from tmpud.symbols import Action, Cost, LazyCost, Place, ServiceRequest, Transition


def road(edge: str, lanes: int = 1, length: float = 50.0, y: float = 0.0) -> list[Lane]:
    """Return the lanes of a straight road to the east; ``<edge>_0`` is the rightmost."""
    return [
        Lane(f"{edge}_{i}", edge, i, Polyline([(0, y + 3 * i), (length, y + 3 * i)]), (0.0, 0.0), 3.0, 13.9)
        for i in range(lanes)
    ]


def link(from_lane: str, to_lane: str, action: Action = Action.FORWARD, *, turnaround: bool = False) -> LaneConnection:
    path = Polyline([(0, 0), (10, 0)])
    return LaneConnection(from_lane, to_lane, action, "junction", path, (), turnaround=turnaround)


def network(roads: Iterable[list[Lane]], links: Iterable[LaneConnection], segment_length: float = 60.0) -> RoadNetwork:
    lanes = {lane.id: lane for row in roads for lane in row}
    return RoadNetwork("tiny", lanes, tuple(links), {}, {}, segment_length=segment_length)


def request(start: str, *goals: str | tuple[str, ...]) -> ServiceRequest:
    """Return a request between segments; a goal may be any of several."""
    rows = [(goal,) if isinstance(goal, str) else goal for goal in goals]
    return ServiceRequest(Place(start, (start,)), tuple(Place("/".join(row), row) for row in rows))


def random_network(rng: random.Random, crossings: int = 3, roads: int = 6) -> RoadNetwork:
    """Return roads between random crossings, with random lanes, segments, turns and bans on lane changes."""
    ring = [(i, (i + 1) % crossings) for i in range(crossings)]
    ends = ring + [(rng.randrange(crossings), rng.randrange(crossings)) for _ in range(roads - crossings)]
    rows = [
        [_marked(lane, rng) for lane in road(f"e{i}", rng.choice((1, 1, 2, 3)), rng.choice((50.0, 100.0, 170.0)))]
        for i in range(roads)
    ]
    links = [
        link(before.id, after.id, action, turnaround=rng.random() < 0.05)
        for (_, middle), row in zip(ends, rows, strict=True)
        for (origin, _), other in zip(ends, rows, strict=True)
        if middle == origin
        for before in row
        for after in other
        for action in rng.sample((Action.FORWARD, Action.TURNLEFT, Action.TURNRIGHT), rng.choice((0, 1, 1, 1, 1, 2)))
    ]
    return network(rows, links)


def _marked(lane: Lane, rng: random.Random) -> Lane:
    return replace(lane, change_left=_open(rng), change_right=_open(rng))


def _open(rng: random.Random) -> tuple[Stretch, ...]:
    return WHOLE if rng.random() < 0.8 else NOWHERE


def grid(blocks: int, rng: random.Random | None = None) -> RoadNetwork:
    """Return a town of square blocks, two lanes each way; with ``rng`` the roads have random lengths."""
    nodes = [(i, j) for i in range(blocks) for j in range(blocks)]
    headings = {Action.FORWARD: 0, Action.TURNLEFT: 1, Action.TURNRIGHT: 3}
    ways = ((1, 0), (0, 1), (-1, 0), (0, -1))
    edges = [(n, d) for n in nodes for d in range(4) if (n[0] + ways[d][0], n[1] + ways[d][1]) in nodes]
    name = {(n, d): f"{n[0]}.{n[1]}-{'ENWS'[d]}" for n, d in edges}
    lengths = {edge: rng.uniform(40, 58) if rng else 50.0 for edge in edges}
    links = [
        link(f"{name[n, d]}_{a}", f"{name[m, e]}_{b}", action)
        for n, d in edges
        for action, turn in headings.items()
        for m, e in [((n[0] + ways[d][0], n[1] + ways[d][1]), (d + turn) % 4)]
        if (m, e) in name
        for a, b in {Action.FORWARD: ((0, 0), (1, 1)), Action.TURNLEFT: ((1, 1),), Action.TURNRIGHT: ((0, 0),)}[action]
    ]
    return network([road(name[edge], 2, 2 * lengths[edge]) for edge in edges], links)


def driven(network: RoadNetwork) -> Cost:
    """Return the length from mid-point to mid-point, 10 m more through a junction [m]."""

    def length(transition: Transition) -> float:
        here, there = (network.segments[state.segment] for state in (transition.state, transition.next_state))
        across = network.lanes[here.lane].edge != network.lanes[there.lane].edge
        return (here.end - here.start + there.end - there.start) / 2 + 10.0 * across

    return LazyCost(length)


def two_blocks(block: float) -> RoadNetwork:
    """Return a road ``a``, ``b`` of two lanes each way; its left lane turns left into ``goal`` after two blocks.

    Going straight on instead, one comes round a block (``c``, ``d``, ``e``, ``f``, [m] long each) to the same corner.
    """
    ways = [road("a", 2, 100.0), road("b", 2, 100.0), road("-a", 2, 100.0), road("-b", 2, 100.0), road("goal")]
    ways += [road(edge, 1, block) for edge in "cdef"]
    links = [link("a_0", "b_0"), link("a_1", "b_1"), link("-b_0", "-a_0"), link("-b_1", "-a_1"), link("b_0", "c_0")]
    links += [
        link(before, after, Action.TURNRIGHT) for before, after in (("c_0", "d_0"), ("d_0", "e_0"), ("e_0", "f_0"))
    ]
    links += [link("b_1", "goal_0", Action.TURNLEFT), link("f_0", "goal_0")]
    return network(ways, links)
