"""Where everything on the road is between two frames."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmpud.events import Frame
from tmpud.geometry import Pose, wrap_angle

JUMP = 8.0  # [m] between frames: too far to be driven, so it is not drawn as if it were


@dataclass(frozen=True, slots=True)
class Traffic:
    """What is to be seen at one instant."""

    ego: Pose
    others: Mapping[str, Pose]
    signals: Mapping[str, str]


class Recording:
    """The frames of a run, which are in order and at least one."""

    def __init__(self, frames: Sequence[Frame]) -> None:
        self._frames = frames
        self._times = [frame.time for frame in frames]

    def at(self, time: float) -> Traffic:
        """Return the traffic at a time [s]; before the first and after the last frame it is theirs."""
        number = max(bisect_right(self._times, time) - 1, 0)
        before = self._frames[number]
        after = self._frames[min(number + 1, len(self._frames) - 1)]
        gap = after.time - before.time
        share = min(max((time - before.time) / gap, 0.0), 1.0) if gap > 0 else 0.0
        later = dict(zip(after.ids, after.others, strict=True))
        others = {
            name: between(pose(row), pose(later.get(name, row)), share)
            for name, row in zip(before.ids, before.others, strict=True)
        }
        return Traffic(between(pose(before.ego), pose(after.ego), share), others, before.signals)


def pose(row: Sequence[int]) -> Pose:
    """Return the pose of a frame's row."""
    return Pose(row[0] / 100, row[1] / 100, row[2] / 1000)


def between(start: Pose, end: Pose, share: float) -> Pose:
    """Return the pose a share of the way on, turning the short way round."""
    if math.hypot(end.x - start.x, end.y - start.y) > JUMP:
        return start
    turn = wrap_angle(end.heading - start.heading)
    return Pose(
        start.x + share * (end.x - start.x),
        start.y + share * (end.y - start.y),
        wrap_angle(start.heading + share * turn),
    )
