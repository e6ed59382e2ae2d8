"""Circulating traffic: random walks over a road network that never run out."""

from __future__ import annotations

import random

from tmpud.errors import SimulatorError
from tmpud.roads.network import RoadNetwork

WISHED_SPEED = 20.0 / 3.6  # [m/s]
SPREAD = 0.1  # share of the wished speed by which drivers differ, either way
SPACING = 12.0  # [m] between cars when they are put on the road
AHEAD = 12  # roads of a route that are known beforehand


class Circulation:
    """Roads on which cars can drive for ever, and random walks over them."""

    def __init__(self, network: RoadNetwork, rng: random.Random) -> None:
        self._network, self._rng = network, rng
        self._following = _following_roads(network)
        self._next = _circular_roads(self._following)

    def walk(self, road: str, length: int = AHEAD) -> list[str]:
        """Return a random walk that goes on after a road, the road itself left out.

        It is as long as asked for on roads that circulate; one that begins elsewhere may come to a dead end.
        """
        found: list[str] = []
        while len(found) < length and (ways := self._next.get(road) or self._following[road]):
            road = self._rng.choice(ways)
            found.append(road)
        return found

    def places(self, count: int) -> list[tuple[str, float]]:
        """Return ``count`` (lane, station) drawn among all that are SPACING apart; SimulatorError for too many."""
        if count and not self._next:
            raise SimulatorError(f"{self._network.name}: no road on which traffic could circulate")
        free = [
            (lane, SPACING * (i + 0.7))
            for road in self._next
            for lane in self._network.edges[road]
            for i in range(int(self._network.lanes[lane].length / SPACING - 0.7))
        ]
        if count > len(free):
            raise SimulatorError(f"{count} vehicles do not fit on {self._network.name}: there is room for {len(free)}")
        return self._rng.sample(free, count)

    def __contains__(self, road: object) -> bool:
        return road in self._next


def _following_roads(network: RoadNetwork) -> dict[str, list[str]]:
    """Return road -> following roads."""
    following: dict[str, set[str]] = {road: set() for road in network.edges}
    for connection in network.connections:
        following[network.lanes[connection.from_lane].edge].add(network.lanes[connection.to_lane].edge)
    return {road: sorted(after) for road, after in following.items()}


def _circular_roads(roads: dict[str, list[str]]) -> dict[str, list[str]]:
    """Return road -> following roads, without those that lead to a dead end."""
    following = {road: set(after) for road, after in roads.items()}
    while ends := {road for road, after in following.items() if not after}:
        following = {road: after - ends for road, after in following.items() if road not in ends}
    return {road: sorted(following[road]) for road in sorted(following)}
