"""Stop lines: red lights, and signs at which the ego must stand."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from tmpud.judging.rules import JudgingRules, Kind, Verdict
from tmpud.roads.network import Lane, LaneConnection, RoadNetwork
from tmpud.scene import Scene, VehicleState

_LOOK_BACK = 20.0  # [m] the part of a lane before its line on which the ego's front is sought


class StopLines:
    """The front bumper crosses the end of a lane against a red light, or a stop sign without having stood before it.

    Which light counts is known when the ego enters a lane of the junction: its connection names the light. The letter
    is the one shown at the last step with the bumper before the line.
    """

    def __init__(self, network: RoadNetwork, rules: JudgingRules) -> None:
        self._network, self._rules = network, rules
        self._start("")

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        lane = scene.ego.lane
        way = self._entered(lane) if lane != self._lane else None
        verdicts = list(self._judged(scene, way)) if way else []
        if way:
            self._start("")
        if lane in self._network.lanes:
            if lane != self._lane:
                self._start(lane)
            self._approach(scene, self._network.lanes[lane])
        return verdicts

    def _start(self, lane: str) -> None:
        self._lane = lane
        self._signals: Mapping[str, str] | None = None  # None: the front was never seen before the line
        self._stood = False

    def _approach(self, scene: Scene, lane: Lane) -> None:
        left = _before_line(scene.ego, lane)
        if left > 0.0:
            self._signals = scene.signals
            near = left <= self._rules.stop_zone and scene.ego.speed < self._rules.stood
            self._stood = self._stood or near

    def _entered(self, lane: str) -> LaneConnection | None:
        """Return the connection that leads from the lane approached to the one the ego is on now."""
        ways = self._network.outgoing(self._lane) if self._lane else []
        return next((way for way in ways if lane == way.to_lane or lane in way.internal_lanes), None)

    def _judged(self, scene: Scene, way: LaneConnection) -> Iterable[Verdict]:
        if self._signals is None:
            return
        detail = f"from {way.from_lane} to {way.to_lane} at {scene.ego.speed:.1f} m/s"
        if way.signal is not None and self._signals.get(way.signal, "")[way.link : way.link + 1] == "r":
            yield Verdict(scene.time, Kind.RED_LIGHT, None, f"{way.signal}:{way.link}", "ego", detail)
        if way.signal is None and way.priority in ("s", "w") and not self._stood:
            yield Verdict(scene.time, Kind.STOP_LINE, None, way.from_lane, "ego", detail)


def _before_line(ego: VehicleState, lane: Lane) -> float:
    """Return how far the ego's front bumper is before the end of a lane, 0 beyond it [m]."""
    x, y, heading = ego.pose
    front = x + ego.length / 2 * math.cos(heading), y + ego.length / 2 * math.sin(heading)
    left = lane.length - lane.centre.project(*front, after=lane.length - _LOOK_BACK)[0]
    return left if left > 1e-6 else 0.0
