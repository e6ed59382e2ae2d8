"""SUMO's own router, asked through libsumo, on nets where a route of roads is a plan of lanes."""

from __future__ import annotations

from contextlib import redirect_stdout
from pathlib import Path
from sys import modules, stderr
from typing import Any

from benchmarks.harness import SkipError
from benchmarks.questions import Graph

OPTIONS = ("--no-step-log", "--weights.minor-penalty", "0")
TOLERANCE = 50.0  # [cm] the net file rounds the length of each lane on the way


class SumoRouter:
    """A Router over roads, by travel time at one speed; our ways lead from middle to middle of a lane."""

    def __init__(self, graph: Graph, file: Path) -> None:
        """Raise SkipError where routes and plans are not the same thing."""
        network, lanes = graph.network, graph.network.lanes
        self._speed = next(iter(lanes.values())).speed
        if len(network.edges) < len(lanes) or any(lane.speed != self._speed for lane in lanes.values()):
            raise SkipError("its routes are comparable where roads have one lane and one speed")
        if len(network.segments) > len(lanes):
            raise SkipError("its routes are comparable where each lane is one segment")
        self._graph, self._lanes = graph, [segment.lane for segment in network.segments.values()]
        self._ends = list(graph.edges)
        self._libsumo = _started(file)
        through = {lane for link in network.connections for lane in link.internal_lanes}
        if any(self._libsumo.lane.getMaxSpeed(lane) != self._speed for lane in through):
            close()
            raise SkipError("its routes are comparable where turns are as quick as roads")

    def weigh(self, edge: int, weight: int) -> None:
        """Put what the transition costs more than at first on the way through the junction."""
        network, (a, b) = self._graph.network, self._ends[edge]
        (link,) = [way for way in network.outgoing(self._lanes[a]) if way.to_lane == self._lanes[b]]
        more = (weight - self._graph.weights[edge]) / 100
        for through in link.internal_lanes:
            length = self._libsumo.lane.getLength(through)
            seconds = (length + more / len(link.internal_lanes)) / self._speed
            self._libsumo.edge.adaptTraveltime(through.rpartition("_")[0], seconds)

    def shortest(self, start: int, goal: int) -> float:
        lanes = [self._graph.network.lanes[self._lanes[node]] for node in (start, goal)]
        route = self._libsumo.simulation.findRoute(lanes[0].edge, lanes[1].edge)
        return float(100 * (route.travelTime * self._speed - (lanes[0].length + lanes[1].length) / 2))


def _started(file: Path) -> Any:
    with redirect_stdout(stderr):
        import libsumo
    if libsumo.isLoaded():
        raise SkipError("another simulation is loaded in this process")
    libsumo.start(["sumo", "-n", str(file), *OPTIONS])
    return libsumo


def close() -> None:
    """End the simulation that a router started, if one did."""
    libsumo = modules.get("libsumo")
    if libsumo and libsumo.isLoaded():
        libsumo.close()
