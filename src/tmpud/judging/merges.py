"""The merges of a trial: when each began, whether the ego is across, and who drives behind it since."""

from __future__ import annotations

from dataclasses import dataclass

from tmpud.judging.rules import JudgingRules
from tmpud.roads.network import Lane, RoadNetwork
from tmpud.scene import Scene, VehicleState


@dataclass(slots=True)
class Merge:
    """One merge from its start on."""

    started: float  # [s]
    origin: str
    target: str
    transition: str  # as text, for the record
    movers: frozenset[str]  # vehicles that moved when it began
    under_way: bool = True  # until the ego's centre is on the target lane, or the ego is elsewhere


class MergeLog:
    """What the rules need to know about merges; to be shown every scene before the rules see it."""

    def __init__(self, network: RoadNetwork, rules: JudgingRules) -> None:
        self._network, self._rules = network, rules
        self._merges: list[Merge] = []
        self.followers: tuple[tuple[Merge, int], ...] = ()  # index in the last scene of the one behind the ego

    def began(self, scene: Scene, origin: str, target: str, transition: str) -> None:
        moving = scene.others.speed > self._rules.moved
        movers = frozenset(name for name, moves in zip(scene.others.ids, moving, strict=True) if moves)
        self._merges.append(Merge(scene.time, origin, target, transition, movers))

    def observe(self, scene: Scene) -> None:
        for merge in self._merges:
            merge.under_way = merge.under_way and self._still_crossing(merge, scene.ego)
        self._merges = [merge for merge in self._merges if merge.under_way or self._recent(merge, scene.time)]
        found = ((merge, self._follower(merge, scene)) for merge in self._merges)
        self.followers = tuple((merge, index) for merge, index in found if index is not None)

    @property
    def answerable(self) -> tuple[Merge, ...]:
        """The merges under way or begun within the window, the latest last."""
        return tuple(self._merges)

    def _recent(self, merge: Merge, time: float) -> bool:
        return time - merge.started <= self._rules.merge_window + 1e-9

    def _still_crossing(self, merge: Merge, ego: VehicleState) -> bool:
        elsewhere = bool(ego.lane) and ego.lane not in (merge.origin, merge.target)
        return not elsewhere and not on_lane(self._network.lanes[merge.target], ego)

    def _follower(self, merge: Merge, scene: Scene) -> int | None:
        """Return the vehicle on the target lane whose nearest vehicle ahead there is the ego."""
        target, others = self._network.lanes[merge.target], scene.others
        if not on_lane(target, scene.ego):
            return None
        own = target.centre.project(scene.ego.pose.x, scene.ego.pose.y)[0]
        there = [i for i, lane in enumerate(others.lanes) if lane == merge.target]
        stations = ((target.centre.project(float(others.x[i]), float(others.y[i]))[0], i) for i in there)
        return max(((station, i) for station, i in stations if station < own), default=(0.0, None))[1]


def on_lane(lane: Lane, vehicle: VehicleState) -> bool:
    """Whether a vehicle's centre lies between the borders of a lane."""
    return abs(lane.centre.project(vehicle.pose.x, vehicle.pose.y)[1]) <= lane.width / 2
