"""What counts as unsafe: every constant of the judging rules, and the verdicts they lead to."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, Protocol

from tmpud.scene import Scene


@dataclass(frozen=True, slots=True, kw_only=True)
class JudgingRules:
    """The constants of all rules; independent of planner and simulator."""

    # Collisions
    level: float = 3.0  # [m] vehicles this far above or below cannot touch
    same_direction: float = math.radians(45.0)  # [rad] headings at most this far apart go the same way
    merge_window: float = 8.0  # [s] after its start a merge answers for what follows
    bumper: float = 0.5  # [m] depth of the box at the ego's front or rear that counts as its bumper
    standing: float = 0.1  # [m/s] an ego slower than this did not drive into anything

    # Forced stops and hard braking of the vehicle behind a merge
    moved: float = 2.0  # [m/s] it drove faster than this when the merge began ...
    stopped: float = 1.0  # [m/s] ... and falls below this ...
    faster: float = 1.0  # [m/s] ... while the ego is at least so much faster
    hard_braking: float = 4.4  # [m/s^2] braking above this is recorded

    # Rules of the road
    stop_zone: float = 5.0  # [m] before a stop line, where the ego must have stood ...
    stood: float = 0.3  # [m/s] ... slower than this
    lane_margin: float = 0.3  # [m] the ego's centre may be this far outside of a lane
    jump_margin: float = 0.2  # [m] the ego may move this much further than its speed allows
    max_speed: float = 20.0 / 3.6  # [m/s] the ego's own limit
    speed_margin: float = 0.1  # share of the limit by which it may be exceeded


class Kind(StrEnum):
    """What a verdict is about."""

    COLLISION = "collision"
    FORCED_STOP = "forced_stop"
    HARD_BRAKING = "hard_braking"
    RED_LIGHT = "red_light"
    STOP_LINE = "stop_line"
    OFF_LANE = "off_lane"
    JUMP = "jump"
    SPEEDING = "speeding"


UNSAFE = frozenset({Kind.COLLISION, Kind.FORCED_STOP})
RECORDED = frozenset({Kind.HARD_BRAKING})  # neither unsafe behaviour nor a violation

Blame = Literal["ego", "other"]


@dataclass(frozen=True, slots=True)
class Verdict:
    """One incident, named at the first instant at which it is certain."""

    time: float  # [s] simulated
    kind: Kind
    vehicle: str | None  # the other vehicle; None where there is none
    rule: str  # collisions: merge, rear-end, crossing or other; else what was broken: a light, a lane, a limit
    blame: Blame
    detail: str  # for people


class Rule(Protocol):
    """One rule, asked at every step of the simulator."""

    def observe(self, scene: Scene) -> Iterable[Verdict]:
        """Return the incidents that became certain with this scene, each once and not at every step it lasts."""
        ...


class Rising:
    """Tells when a condition becomes true, so that an incident that lasts counts once."""

    def __init__(self) -> None:
        self._before = False

    def __call__(self, condition: bool) -> bool:
        rising = condition and not self._before
        self._before = condition
        return rising
