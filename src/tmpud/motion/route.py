"""The driven path as arrays: what the speed planner and the tracking controller look things up on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tmpud.dynamics import EGO, VehicleLimits
from tmpud.geometry import Point, Polyline, Pose, wrap_angle
from tmpud.motion.path import Change, Cross, Move, outline
from tmpud.roads.network import RoadNetwork
from tmpud.scene import FloatArray

SPACING = 0.5  # [m] between the points of a route
SMOOTHING = 2.0  # [m] length of the running mean that takes the corners off a map's polylines
COMFORTABLE_BRAKING = 2.0  # [m/s^2]


@dataclass(frozen=True, slots=True)
class Gate:
    """A stop line on the route, before one connection."""

    station: float  # [m] on the route
    connection: int  # index in RoadNetwork.connections
    exit: float  # [m] station at which the junction is left


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """A smooth path to the goal pose and beyond, with what governs the speed on it."""

    x: FloatArray  # (P,) [m] of points at most SPACING apart
    y: FloatArray  # (P,) [m]
    headings: FloatArray  # (P,) [rad]
    poses: Sequence[Pose]  # the same P points, one by one
    curvature: FloatArray  # (P,) [1/m], positive to the left
    speed_limit: FloatArray  # (P,) [m/s] what road, vehicle and the curves ahead allow
    end: float  # [m] station of the goal pose
    gates: tuple[Gate, ...]
    line_crossing: float | None  # [m] station at which a lane change crosses the line; None where there is none

    @property
    def length(self) -> float:
        return (len(self.x) - 1) * SPACING

    def index(self, station: float) -> int:
        return min(max(round(station / SPACING), 0), len(self.x) - 1)

    def pose_at(self, station: float) -> Pose:
        """Return the pose at a station, between the points by straight lines."""
        place = min(max(station / SPACING, 0.0), len(self.x) - 1.001)
        i = int(place)
        share = place - i
        x, y = (float(of[i] + share * (of[i + 1] - of[i])) for of in (self.x, self.y))
        turn = wrap_angle(float(self.headings[i + 1] - self.headings[i]))
        return Pose(x, y, wrap_angle(float(self.headings[i]) + share * turn))

    def project(self, x: float, y: float, near: float | None = None) -> tuple[float, float]:
        """Return (station, offset to the left) of a point [m]; with ``near``, only within 8 m of that station."""
        among = range(len(self.x))
        if near is not None:
            among = among[self.index(near - 8.0) : self.index(near + 8.0) + 1]
        i = self.nearest(x, y, among, self.index(near or 0.0))
        along, across = self.beside(x, y, i)
        return i * SPACING + along, across

    def nearest(self, x: float, y: float, among: range, guess: int) -> int:
        """Return which of some points that follow each other is nearest to (x, y); the better the guess, the sooner."""
        poses, hypot, nearest = self.poses, math.hypot, guess
        px, py, _ = poses[guess]
        least = hypot(x - px, y - py)
        i, end = among.start, among.stop
        while i < end:
            px, py, _ = poses[i]
            distance = hypot(x - px, y - py)
            if distance < least:
                nearest, least = i, distance
            i += 1 + int((distance - least) / SPACING)  # those between are no nearer
        return nearest

    def beside(self, x: float, y: float, i: int) -> tuple[float, float]:
        """Return how far ahead and to the left of the route's i-th point a point is [m]."""
        place = self.poses[i]
        dx, dy = x - place.x, y - place.y
        cos, sin = math.cos(place.heading), math.sin(place.heading)
        return dx * cos + dy * sin, dy * cos - dx * sin


def build_route(
    network: RoadNetwork, moves: Sequence[Move], beyond: Sequence[Move], limits: VehicleLimits = EGO
) -> Route:
    """Join the moves to the goal pose, and those that follow it, into a route."""
    points: list[Point] = []
    limit: list[tuple[float, float]] = []  # (raw station up to which it holds, speed limit)
    gates: list[Gate] = []
    crossing: float | None = None
    driven = 0.0
    for move in (*moves, *beyond):
        piece = outline(move)
        length = Polyline(piece).length if len(piece) > 1 else 0.0
        if isinstance(move, Cross):
            gates.append(Gate(driven, network.index_of(move.connection), driven + length))
        elif isinstance(move, Change):
            crossing = driven + length / 2
        points += piece
        driven += length
        limit.append((driven, _speed_limit(move)))
    end = sum(Polyline(piece).length for piece in map(outline, moves) if len(piece) > 1)
    return _sampled(Polyline(points), end, limit, tuple(gates), crossing, limits)


def _speed_limit(move: Move) -> float:
    """Return the limit of a move's lanes, the lower one on a lane change; inf within a junction [m/s]."""
    if isinstance(move, Cross):
        return math.inf
    return min(move.lane.speed, move.target.speed) if isinstance(move, Change) else move.lane.speed


def _sampled(
    line: Polyline,
    end: float,
    limit: list[tuple[float, float]],
    gates: tuple[Gate, ...],
    crossing: float | None,
    limits: VehicleLimits,
) -> Route:
    count = max(int(line.length / SPACING) + 1, 3)
    stations: FloatArray = np.arange(count, dtype=np.float64) * SPACING
    x, y = np.ascontiguousarray(_smooth(_points_at(line, stations)).T)
    headings = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    steps = np.hypot(np.gradient(x), np.gradient(y))
    curvature = np.gradient(headings) / np.maximum(steps, 1e-6)
    allowed = np.minimum(
        _limits_at(stations, limit),
        np.sqrt(limits.max_lateral_acceleration * 0.8 / np.maximum(np.abs(curvature), 1e-6)),
    )
    allowed = _braked(np.minimum(allowed, limits.max_speed))
    poses = tuple(map(Pose, x.tolist(), y.tolist(), headings.tolist()))
    return Route(x, y, headings, poses, curvature, allowed, end, gates, crossing)


def _points_at(line: Polyline, stations: FloatArray) -> FloatArray:
    """Return the points (P, 2) of a line at stations on it (P,)."""
    points, begins = np.array(line.points), np.array(line.stations)
    pieces = np.minimum(np.searchsorted(begins, stations, side="right") - 1, len(begins) - 2)
    directions = np.diff(points, axis=0) / np.diff(begins)[:, None]
    return np.asarray(points[pieces] + (stations - begins[pieces])[:, None] * directions[pieces])


def _braked(allowed: FloatArray) -> FloatArray:
    """Return the speeds (P,) that allow for braking in time for what comes: v_i^2 <= v_j^2 + 2 b (s_j - s_i)."""
    gained = 2 * COMFORTABLE_BRAKING * SPACING * np.arange(len(allowed))
    least = np.minimum.accumulate((allowed**2 + gained)[::-1])[::-1]
    return np.asarray(np.minimum(np.sqrt(least - gained), allowed))


def _limits_at(stations: FloatArray, limit: list[tuple[float, float]]) -> FloatArray:
    ends = np.array([s for s, _ in limit])
    speeds = np.array([v for _, v in limit])
    return np.asarray(speeds[np.minimum(np.searchsorted(ends, stations), len(speeds) - 1)], dtype=np.float64)


def _smooth(points: FloatArray) -> FloatArray:
    """Take a running mean over SMOOTHING metres, shorter towards the ends so that they stay where they are."""
    half = int(SMOOTHING / SPACING / 2)
    summed = np.vstack([np.zeros((1, 2)), np.cumsum(points, axis=0)])
    index = np.arange(len(points))
    reach = np.minimum(np.minimum(index, len(points) - 1 - index), half)
    means = (summed[index + reach + 1] - summed[index - reach]) / (2 * reach + 1)[:, None]
    return np.asarray(means, dtype=np.float64)
