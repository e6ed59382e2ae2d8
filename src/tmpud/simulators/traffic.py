"""Circulating traffic: cars that make one trip after another where a mission goes, for ever."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from itertools import pairwise
from typing import NamedTuple

from tmpud.errors import SimulatorError
from tmpud.roads.moves import strong_parts
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Place, ServiceRequest

WISHED_SPEED = 20.0 / 3.6  # [m/s]
SPREAD = 0.1  # share of the wished speed by which drivers differ, either way
SPACING = 12.0  # [m] between cars when they are put on the road
AHEAD = 12  # roads of a route that are known beforehand
SAMPLE = 2000  # roads of the trips that tell how busy each road will be

Graph = dict[str, dict[str, float]]  # road -> following road -> length of the way to the following road's end [m]


class Spot(NamedTuple):
    """A place on the road."""

    lane: str
    station: float  # [m]


@dataclass(frozen=True, slots=True, kw_only=True)
class TrafficRules:
    """Where the others drive and how. Grounds, and what was tried: docs/experiments.md, Traffic."""

    local: float = 48.0  # [1/km] cars per km of the mission's lanes whose trips lead to its roads; the rest go anywhere
    most_local: int = 45  # ... and not more, or all who drive the same way round end in a gridlock
    detour: float = 200.0  # [m] a road is of the mission where the way by it is at most so much longer
    wished_speed: float = WISHED_SPEED  # [m/s] the paper's (Sec. V)
    spread: float = SPREAD
    min_gap: float = 4.0  # [m] between bumpers in a queue; about what CARLA's traffic keeps
    keep_right: float = 0.0  # SUMO's lcKeepRight: nobody leaves the left lane for its own sake


class Circulation:
    """The roads on which cars can drive for ever, and trips over them.

    Each trip goes the shortest way to a road drawn from all; local cars', to a road of the mission: one by which the
    request's legs can be driven with a small detour. Map and request decide, so that all algorithms meet the same
    traffic.
    """

    def __init__(
        self,
        network: RoadNetwork,
        rng: random.Random,
        request: ServiceRequest | None = None,
        rules: TrafficRules | None = None,
    ) -> None:
        self._network, self._rng = network, rng
        self._graph = _road_graph(network)
        self._backwards = _reversed(self._graph)
        self._roads = _circular_part(self._graph)
        self._rules = rules or TrafficRules()
        wanted = _roads_of_interest(self._graph, network, request, self._rules.detour) if request else ()
        self._everywhere, self._mission = tuple(sorted(self._roads)), tuple(sorted(self._roads.intersection(wanted)))
        self._spots = tuple(
            Spot(lane, SPACING * (i + 0.7))
            for road in self._everywhere
            for lane in network.edges[road]
            for i in range(int(network.lanes[lane].length / SPACING - 0.7))
        )
        self._to_go: dict[str, dict[str, float]] = {}  # destination -> road -> way from that road's end [m]

    def locals_among(self, count: int) -> int:
        """Return how many of some cars stay where the mission goes: none on a single road, which all would go round."""
        if len(self._mission) < 2:
            return 0
        length = sum(self._network.lanes[lane].length for road in self._mission for lane in self._network.edges[road])
        return min(round(self._rules.local * length / 1000), self._rules.most_local, count)

    def walk(self, road: str, length: int = AHEAD, *, local: bool = False) -> list[str]:
        """Return trips that go on after a road, at least ``length`` roads; none where it leads to no destination."""
        destinations = self._mission if local and self._mission else self._everywhere
        found: list[str] = []
        while len(found) < length and destinations:
            here = found[-1] if found else road
            goals = [goal for goal in destinations if goal != here] or destinations
            trip = self._trip(here, self._rng.choice(goals))
            if not trip:
                break
            found += trip
        return found

    @property
    def room(self) -> int:
        """How many cars can be put on the road."""
        return len(self._spots)

    def places(self, count: int) -> list[Spot]:
        """Return ``count`` spots SPACING apart, drawn by how often trips lead there, the busiest roads first.

        Raises SimulatorError for too many.
        """
        if count and not self._roads:
            raise SimulatorError(f"{self._network.name}: no road on which traffic could circulate")
        if count > self.room:
            raise SimulatorError(f"{count} vehicles do not fit on {self._network.name}: there is room for {self.room}")
        if not count:
            return []
        visits = self._visits(self.locals_among(count) / count)
        # The greatest of u^(1/w), with u uniform, are a sample by weights w without replacement (Efraimidis 2006).
        roads = {spot: self._network.lanes[spot.lane].edge for spot in self._spots}
        drawn = {
            spot: self._rng.random() ** (len(self._network.edges[road]) / visits[road]) for spot, road in roads.items()
        }
        return sorted(drawn, key=lambda spot: (-drawn[spot], spot))[:count]

    def __contains__(self, road: object) -> bool:
        return road in self._roads

    def _visits(self, local: float) -> dict[str, float]:
        """Return how often a road is driven where a share of the cars is local; never 0."""
        start = min(self._roads)
        near, anywhere = (Counter(self.walk(start, SAMPLE, local=here)) for here in (True, False))
        return {road: 1 + local * near[road] + (1 - local) * anywhere[road] for road in self._roads}

    def _trip(self, road: str, goal: str) -> list[str]:
        """Return the roads of the shortest way from a road to another, or round to itself; none where none leads."""
        if goal not in self._to_go:
            self._to_go[goal] = _lengths(self._backwards, {goal})
        to_go, trip = self._to_go[goal], list[str]()
        while road != goal or not trip:
            ways = [(length + to_go[way], way) for way, length in self._graph[road].items() if way in to_go]
            if not ways:
                return []
            road = min(ways)[1]
            trip.append(road)
        return trip


def _road_graph(network: RoadNetwork) -> Graph:
    graph: Graph = {road: {} for road in sorted(network.edges)}
    for connection in network.connections:
        here, there = network.lanes[connection.from_lane].edge, network.lanes[connection.to_lane]
        length = connection.path.length + there.length
        graph[here][there.edge] = min(length, graph[here].get(there.edge, length))
    return graph


def _circular_part(graph: Graph) -> frozenset[str]:
    """Return the most roads of which each can be reached from every other."""
    parts = strong_parts({road: sorted(ways) for road, ways in graph.items()})
    rings = (part for part in parts if len(part) > 1 or any(road in graph[road] for road in part))
    return max(rings, key=len, default=frozenset())


def _roads_of_interest(graph: Graph, network: RoadNetwork, request: ServiceRequest, detour: float) -> set[str]:
    """Return the roads on the ways, leg by leg, that are at most ``detour`` longer than the shortest one."""
    stops = [_roads_at(network, place) for place in (request.start, *request.goals)]
    backwards, found = _reversed(graph), set[str]()
    for start, goal in pairwise(stops):
        here, there = _lengths(graph, start), _lengths(backwards, goal)
        by_way = {road: here[road] + there[road] for road in here.keys() & there.keys()}
        found.update(road for road, length in by_way.items() if length <= min(by_way.values()) + detour)
    return found


def _roads_at(network: RoadNetwork, place: Place) -> set[str]:
    return {network.lanes[network.segments[segment].lane].edge for segment in place.segments}


def _reversed(graph: Graph) -> Graph:
    backwards: Graph = {road: {} for road in graph}
    for road, ways in graph.items():
        for way, length in ways.items():
            backwards[way][road] = length
    return backwards


def _lengths(graph: Graph, starts: Iterable[str]) -> dict[str, float]:
    """Return the length of the shortest way from some roads to each that can be reached (Dijkstra) [m]."""
    lengths = dict.fromkeys(starts, 0.0)
    queue = [(0.0, road) for road in sorted(lengths)]
    heapify(queue)
    while queue:
        so_far, here = heappop(queue)
        if so_far > lengths[here]:
            continue
        for road, length in graph[here].items():
            if so_far + length < lengths.get(road, float("inf")):
                lengths[road] = so_far + length
                heappush(queue, (lengths[road], road))
    return lengths
