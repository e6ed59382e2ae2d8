"""What car following knows of a merge: gap, time to collision and RSS distance on the target lane.

Baselines beside Algorithm 1's Safe. They see the same scene, and for each of them higher means safer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tmpud.roads.network import Lane, RoadNetwork
from tmpud.safety.neighbours import LEVEL
from tmpud.scene import FloatArray, Scene
from tmpud.symbols import Transition

SAME_WAY = math.radians(60.0)  # [rad] vehicles turned further away from the lane only cross it


@dataclass(frozen=True, slots=True)
class RssParameters:
    """What RSS assumes of every driver (Shalev-Shwartz et al. 2017, Definition 1); every driver may do the same."""

    response_time: float = 1.0  # rho [s]
    acceleration: float = 3.0  # a_max,accel [m/s^2] while the one behind has not yet responded
    least_braking: float = 4.0  # a_min,brake [m/s^2] with which the one behind responds
    most_braking: float = 8.0  # a_max,brake [m/s^2] of the one ahead
    standing_gap: float = 1.0  # [m] kept on top of it


@dataclass(frozen=True, slots=True, eq=False)
class LaneGaps:
    """The N vehicles that reach into the target lane, seen from the ego; each field of shape (N,)."""

    gap: FloatArray  # [m] along the lane between the boxes; negative where they are side by side
    rear_speed: FloatArray  # [m/s] along the lane, of whoever is behind: the ego or the vehicle
    front_speed: FloatArray  # [m/s] of whoever is ahead


class MergeGaps(NamedTuple):
    """The baselines' scores of one merge, the worst vehicle's each; inf where nothing is in the way."""

    gap: float  # [m]
    time_to_collision: float  # [s]
    rss_ratio: float  # gap by RSS safe distance; below 1 RSS calls it dangerous


def merge_gaps(scene: Scene, step: Transition, network: RoadNetwork) -> MergeGaps:
    """Return the scores of a merge if it is begun in this scene."""
    found = lane_gaps(scene, network.lanes[network.segments[step.next_state.segment].lane])
    ratio = found.gap / safe_distance(found.rear_speed, found.front_speed, RssParameters())
    return MergeGaps(*(float(score.min(initial=math.inf)) for score in (found.gap, time_to_collision(found), ratio)))


def lane_gaps(scene: Scene, lane: Lane) -> LaneGaps:
    """Return the vehicles whose boxes reach into a lane and drive along it, as the ego's neighbours there."""
    ego, others = scene.ego, scene.others
    own = lane.centre.project(ego.pose.x, ego.pose.y)[0]
    rows = []
    for i in np.flatnonzero(np.abs(others.z - ego.z) < LEVEL):
        station, offset = lane.centre.project(float(others.x[i]), float(others.y[i]))
        turned = float(others.heading[i]) - lane.centre.pose_at(station).heading
        if abs(offset) >= (lane.width + others.width[i]) / 2 or math.cos(turned) < math.cos(SAME_WAY):
            continue
        speed = float(others.speed[i]) * math.cos(turned)
        gap = abs(station - own) - (ego.length + float(others.length[i])) / 2
        rows.append((gap, *((ego.speed, speed) if station > own else (speed, ego.speed))))
    return LaneGaps(*np.array(rows, dtype=np.float64).reshape(-1, 3).T)


def time_to_collision(gaps: LaneGaps) -> FloatArray:
    """Return when each gap is closed at constant speeds (N,) [s]: 0 side by side, inf where it does not close."""
    closing = gaps.rear_speed - gaps.front_speed
    closes = closing > 0
    times = np.where(closes, gaps.gap / np.where(closes, closing, 1.0), np.inf)
    return np.asarray(np.where(gaps.gap <= 0, 0.0, times))


def safe_distance(rear_speed: FloatArray, front_speed: FloatArray, rss: RssParameters) -> FloatArray:
    """Return the distance that lets the one behind stop in time, whatever the one ahead does [m].

    Both drive the same way: Definition 1 of "On a Formal Model of Safe and Scalable Self-driving Cars".
    """
    responding = rear_speed + rss.response_time * rss.acceleration
    distance = (
        rear_speed * rss.response_time
        + rss.acceleration * rss.response_time**2 / 2
        + responding**2 / (2 * rss.least_braking)
        - front_speed**2 / (2 * rss.most_braking)
    )
    return np.asarray(np.maximum(distance, 0.0) + rss.standing_gap)
