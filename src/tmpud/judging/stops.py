"""What a merge forces on the vehicle behind it: a stop, or hard braking."""

from __future__ import annotations

from collections.abc import Iterable

from tmpud.judging.merges import MergeLog
from tmpud.judging.rules import JudgingRules, Kind, Verdict
from tmpud.scene import Scene, Vehicles


class ForcedStops:
    """The follower moved when the merge began and falls below walking speed behind a faster ego; once per vehicle.

    The ego's speed is looked at in the step in which the follower falls below the limit, so an ego that queues itself
    forces nobody to stop, and an ego that drives off later does not turn an old stop into a forced one.
    """

    def __init__(self, rules: JudgingRules, merges: MergeLog) -> None:
        self._rules, self._merges = rules, merges
        self._others: Vehicles | None = None  # at the step before
        self._stopped: set[str] = set()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        before, self._others = self._others or scene.others, scene.others
        for merge, i in self._merges.followers:
            name, speed = scene.others.ids[i], float(scene.others.speed[i])
            falls = _speed(before, name) >= self._rules.stopped > speed
            new = name in merge.movers and name not in self._stopped
            if falls and new and scene.ego.speed >= speed + self._rules.faster:
                self._stopped.add(name)
                detail = f"{speed:.1f} m/s behind the ego at {scene.ego.speed:.1f} m/s"
                yield Verdict(scene.time, Kind.FORCED_STOP, name, merge.transition, "ego", detail)


def _speed(others: Vehicles, name: str) -> float:
    """Return a vehicle's speed, 0 where it is not there [m/s]."""
    return float(others.speed[others.ids.index(name)]) if name in others.ids else 0.0


class HardBraking:
    """The follower moved when the merge began and brakes hard behind the ego; once per vehicle."""

    def __init__(self, rules: JudgingRules, merges: MergeLog) -> None:
        self._rules, self._merges = rules, merges
        self._braked: set[str] = set()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        for merge, i in self._merges.followers:
            name, braking = scene.others.ids[i], -float(scene.others.acceleration[i])
            if braking > self._rules.hard_braking and name in merge.movers and name not in self._braked:
                self._braked.add(name)
                detail = f"brakes at {braking:.1f} m/s^2 behind the ego"
                yield Verdict(scene.time, Kind.HARD_BRAKING, name, merge.transition, "ego", detail)
