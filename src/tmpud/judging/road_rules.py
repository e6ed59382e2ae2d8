"""Rules of the road that need no other vehicle: lanes, jumps, speed limits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from tmpud.geometry import Polyline
from tmpud.judging.rules import JudgingRules, Kind, Rising, Verdict
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.scene import Scene

CAR_LENGTH = 5.0  # [m]

_Curve = tuple[Polyline, float]  # a centre line and the lane's width [m]


class OffLane:
    """The ego's centre is outside of every lane and way through a junction that it can be on.

    Inside a junction any of its ways will do: a simulator may place the ego on the wrong one of two that cross.
    """

    def __init__(self, network: RoadNetwork, rules: JudgingRules) -> None:
        self._network, self._rules = network, rules
        self._ways: dict[str, list[LaneConnection]] = {}  # of each junction
        for way in network.connections:
            self._ways.setdefault(way.junction, []).append(way)
        self._lane = ""  # the last one known
        self._begins = Rising()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        x, y, _ = scene.ego.pose
        self._lane = scene.ego.lane or self._lane or self._network.locate(x, y)[0].id
        off = all(self._outside(curve, x, y) for curve in self._curves(self._lane))
        if self._begins(off):
            detail = f"({x:.2f}, {y:.2f}) is on no lane near {self._lane}"
            yield Verdict(scene.time, Kind.OFF_LANE, None, self._lane, "ego", detail)

    def _outside(self, curve: _Curve, x: float, y: float) -> bool:
        centre, width = curve
        return abs(centre.project(x, y)[1]) > width / 2 + self._rules.lane_margin

    def _curves(self, lane: str) -> Iterator[_Curve]:
        """Yield the lane, then its neighbours and what it is joined to, the likeliest first."""
        if lane in self._network.internal:
            way = self._network.connections[self._network.internal[lane]]
            ways = [way, *self._ways[way.junction], *self._leading_to(way.from_lane)]
        elif lane in self._network.lanes:
            row = (lane, *self._network.edges[self._network.lanes[lane].edge])
            yield from (self._curve(name) for name in row)
            ways = [*self._network.outgoing(lane), *self._leading_to(lane)]
        else:
            ways = []
        for way in ways:
            yield from self._along(way)

    def _leading_to(self, lane: str) -> Iterator[LaneConnection]:
        """Yield the ways into a lane, and those into lanes before it that are shorter than a car."""
        for way in self._network.incoming(lane):
            yield way
            if self._network.lanes[way.from_lane].length < CAR_LENGTH:
                yield from self._leading_to(way.from_lane)

    def _along(self, way: LaneConnection) -> Iterator[_Curve]:
        yield way.path, self._network.lanes[way.from_lane].width
        yield self._curve(way.to_lane)
        yield self._curve(way.from_lane)

    def _curve(self, lane: str) -> _Curve:
        return self._network.lanes[lane].centre, self._network.lanes[lane].width


class Jumps:
    """The ego moves further from one scene to the next than its speed allows."""

    def __init__(self, rules: JudgingRules) -> None:
        self._rules = rules
        self._before: Scene | None = None
        self._begins = Rising()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        before, self._before = self._before or scene, scene
        moved = math.dist(scene.ego.pose[:2], before.ego.pose[:2])
        speed = max(scene.ego.speed, before.ego.speed)
        reach = speed * (scene.time - before.time) + self._rules.jump_margin
        if self._begins(not moved <= reach):
            detail = f"{moved:.2f} m in {scene.time - before.time:.3f} s at {speed:.1f} m/s"
            yield Verdict(scene.time, Kind.JUMP, None, f"{reach:.2f} m", "ego", detail)


class Speeding:
    """The ego is faster than its own limit and the lane's allow; in a junction the faster of its two lanes counts."""

    def __init__(self, network: RoadNetwork, rules: JudgingRules) -> None:
        self._network, self._rules = network, rules
        self._begins = Rising()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        limit = min(self._limit(scene.ego.lane), self._rules.max_speed)
        if self._begins(scene.ego.speed > limit * (1 + self._rules.speed_margin)):
            detail = f"{scene.ego.speed:.2f} m/s on {scene.ego.lane or 'no lane'}"
            yield Verdict(scene.time, Kind.SPEEDING, None, f"{limit:.2f} m/s", "ego", detail)

    def _limit(self, lane: str) -> float:
        lanes = self._network.lanes
        if lane in self._network.internal:
            way = self._network.connections[self._network.internal[lane]]
            return max(lanes[way.from_lane].speed, lanes[way.to_lane].speed)
        return lanes[lane].speed if lane in lanes else math.inf
