"""How near a drive came to a collision, and how smooth it was: minimum time to collision and jerk."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tmpud.judging.rules import JudgingRules
from tmpud.scene import Scene

INTERVAL = 0.2  # [s] between two looks; a difference over one step of 0.05 s shows the controller's noise
LATE = 1e-6  # [s] by which a step may miss its look


class Comfort:
    """Looks at a scene every INTERVAL, from the first one on, and skips those between."""

    def __init__(self, rules: JudgingRules) -> None:
        self.min_ttc = math.inf  # [s] least time to collision; inf where nothing ever closed in
        self.jerk = Jerk()
        self._rules = rules
        self._next_look = -math.inf  # [s]

    def observe(self, scene: Scene) -> None:
        """Take in a scene; to be called in order of time."""
        if scene.time < self._next_look:
            return
        self._next_look = scene.time + INTERVAL - LATE
        self.min_ttc = min(self.min_ttc, time_to_collision(scene, self._rules))
        self.jerk.observe(scene.time, scene.ego.speed)


@dataclass(slots=True)
class Jerk:
    """The change of the mean longitudinal acceleration from one interval between two speeds to the next."""

    largest: float = 0.0  # [m/s^3] magnitude
    count: int = 0
    _squares: float = 0.0  # [m^2/s^6] sum
    _speed: tuple[float, float] | None = None  # [s], [m/s] of the look before
    _acceleration: tuple[float, float] | None = None  # [s] middle of its interval, [m/s^2]

    def observe(self, time: float, speed: float) -> None:
        last, self._speed = self._speed, (time, speed)
        if last is None:
            return
        before, now = self._acceleration, ((time + last[0]) / 2, (speed - last[1]) / (time - last[0]))
        self._acceleration = now
        if before is not None:
            jerk = (now[1] - before[1]) / (now[0] - before[0])
            self.largest = max(self.largest, abs(jerk))
            self.count += 1
            self._squares += jerk * jerk

    @property
    def rms(self) -> float:
        """Root mean square [m/s^3]."""
        return math.sqrt(self._squares / self.count) if self.count else 0.0


def time_to_collision(scene: Scene, rules: JudgingRules) -> float:
    """Return the least time [s] in which a gap between bumpers closes at constant speeds; inf where none closes.

    In the ego's frame, over the vehicles on its level that go its way and overlap its box sideways: of one ahead the
    ego is the faster, of one behind it is the slower. One beside the ego leaves no gap between bumpers.
    """
    # One vehicle after the other: for the dozen in sight this takes less time than arrays
    ego, others, least = scene.ego, scene.others, math.inf
    own_x, own_y, own_heading = ego.pose
    forward_x, forward_y = math.cos(own_heading), math.sin(own_heading)
    same_way = math.cos(rules.same_direction)
    for x, y, z, heading, speed, _, _, length, width in others.bodies:
        dx, dy = x - own_x, y - own_y
        aside = abs(dy * forward_x - dx * forward_y) * 2
        if aside >= ego.width + length + width:  # most are; however it is turned
            continue
        cos, sin = math.cos(heading - own_heading), abs(math.sin(heading - own_heading))
        if cos < same_way or abs(z - ego.z) >= rules.level or aside >= ego.width + sin * length + cos * width:
            continue
        along = dx * forward_x + dy * forward_y
        gap = abs(along) - (ego.length + cos * length + sin * width) / 2
        closing = math.copysign(1.0, along) * (ego.speed - speed * cos)
        if gap > 0 and closing > 0:
            least = min(least, gap / closing)
    return least
