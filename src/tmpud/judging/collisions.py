"""Collisions of the ego: first contact with each vehicle, its class, and who ran into whom."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from tmpud.geometry import wrap_angle
from tmpud.judging.boxes import Box, box_of, overlapping, part_of
from tmpud.judging.merges import Merge, MergeLog
from tmpud.judging.rules import Blame, JudgingRules, Kind, Verdict
from tmpud.scene import Scene, Vehicles


class Collisions:
    """Oriented boxes on the same level overlap; the first frame of contact with a vehicle counts, once."""

    def __init__(self, rules: JudgingRules, merges: MergeLog) -> None:
        self._rules, self._merges = rules, merges
        self._hit: set[str] = set()

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        for i in overlapping(box_of(scene.ego), scene.others):
            name = scene.others.ids[i]
            if name not in self._hit and abs(scene.others.z[i] - scene.ego.z) < self._rules.level:
                self._hit.add(name)
                yield self._verdict(scene, i)

    def _verdict(self, scene: Scene, i: int) -> Verdict:
        ego, others = scene.ego, scene.others
        apart = abs(wrap_angle(float(others.heading[i]) - ego.pose.heading))
        along = apart <= self._rules.same_direction
        merge = self._merge(others.lanes[i]) if along else None
        rule, blame = self._class(scene, others.take(np.arange(len(others)) == i), along, merge)
        detail = (
            f"ego {ego.speed:.1f} m/s, other {others.speed[i]:.1f} m/s, headings {math.degrees(apart):.0f} deg apart"
            + (f", {scene.time - merge.started:.1f} s after the start of {merge.transition}" if merge else "")
        )
        return Verdict(scene.time, Kind.COLLISION, others.ids[i], rule, blame, detail)

    def _merge(self, lane: str) -> Merge | None:
        """Return the merge that answers for a collision with a vehicle on this lane."""
        return next((m for m in reversed(self._merges.answerable) if lane in (m.origin, m.target)), None)

    def _class(self, scene: Scene, other: Vehicles, along: bool, merge: Merge | None) -> tuple[str, Blame]:
        """Without a merge the ego answers where it moved and its front bumper is in the contact."""
        if merge:
            return "merge", "ego"
        ego = box_of(scene.ego)
        if along and self._touches(ego, other, front=False) and _behind(ego, other):
            return "rear-end", "other"
        drove = scene.ego.speed >= self._rules.standing and self._touches(ego, other, front=True)
        return "other" if along else "crossing", "ego" if drove else "other"

    def _touches(self, ego: Box, other: Vehicles, front: bool) -> bool:
        return bool(overlapping(part_of(ego, self._rules.bumper, front), other))


def _behind(ego: Box, other: Vehicles) -> bool:
    dx, dy = float(other.x[0]) - ego.x, float(other.y[0]) - ego.y
    return dx * math.cos(ego.heading) + dy * math.sin(ego.heading) < 0
