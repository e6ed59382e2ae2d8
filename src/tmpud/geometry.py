"""Planar geometry in plain Python: poses, angles, polylines.

Right-handed metres; heading counter-clockwise from the x axis, in (-pi, pi].
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Sequence
from typing import NamedTuple

Point = tuple[float, float]


class Pose(NamedTuple):
    """Position and orientation of the centre of a vehicle's box."""

    x: float  # [m]
    y: float  # [m]
    heading: float  # [rad]


def wrap_angle(angle: float) -> float:
    """Return the same direction in (-pi, pi]."""
    if -math.pi < angle <= math.pi:
        return angle
    wrapped = math.fmod(angle, math.tau)
    if wrapped <= -math.pi:
        return wrapped + math.tau
    return wrapped - math.tau if wrapped > math.pi else wrapped


class _Piece(NamedTuple):
    """One straight piece of a polyline."""

    x: float  # [m] where it begins
    y: float
    ex: float  # its direction, a unit vector
    ey: float
    begin: float  # [m] station
    length: float  # [m]

    @classmethod
    def between(cls, start: Point, begin: float, end: Point, arrive: float) -> _Piece:
        length = arrive - begin
        return cls(*start, (end[0] - start[0]) / length, (end[1] - start[1]) / length, begin, length)


class Polyline:
    """A curve through two or more points, measured by its station (arc length from the start) [m]."""

    __slots__ = ("_pieces", "points", "stations")

    def __init__(self, points: Iterable[Point]) -> None:
        """Join the points in their order; a point equal to the one before it is dropped.

        Raises ValueError where fewer than two distinct points remain.
        """
        kept: list[Point] = []
        stations: list[float] = []
        for x, y in points:
            step = math.hypot(x - kept[-1][0], y - kept[-1][1]) if kept else 0.0
            if kept and step < 1e-9:
                continue
            stations.append(stations[-1] + step if kept else 0.0)
            kept.append((x, y))
        if len(kept) < 2:
            raise ValueError("a polyline needs two distinct points")
        self.points: Sequence[Point] = tuple(kept)
        self.stations: Sequence[float] = tuple(stations)
        self._pieces: Sequence[_Piece] = ()  # until they are asked for: they take most of a city's memory

    @property
    def length(self) -> float:
        return self.stations[-1]

    def _cut(self) -> Sequence[_Piece]:
        """Return the straight pieces, from now on kept."""
        ends = zip(self.points, self.stations, self.points[1:], self.stations[1:], strict=False)
        self._pieces = [_Piece.between(*end) for end in ends]
        return self._pieces

    def _piece(self, station: float) -> int:
        """Return the index of the piece on which a station lies; the first or last one beyond the ends."""
        return min(max(bisect_right(self.stations, station) - 1, 0), len(self.points) - 2)

    def pose_at(self, station: float, offset: float = 0.0) -> Pose:
        """Return the pose at a station, ``offset`` metres to its left; beyond the ends the end pieces go on."""
        x, y, ex, ey, begin, _ = (self._pieces or self._cut())[self._piece(station)]
        along = station - begin
        return Pose(x + along * ex - offset * ey, y + along * ey + offset * ex, math.atan2(ey, ex))

    def project(self, x: float, y: float, after: float = 0.0, before: float = math.inf) -> tuple[float, float]:
        """Return (station, signed offset to the left) of the curve's point nearest to (x, y) [m].

        Only pieces that touch the stations ``after`` to ``before`` are looked at.
        """
        nearest, found = math.inf, (0.0, 0.0)  # (squared distance [m^2], station and side)
        pieces = self._pieces or self._cut()
        last = len(pieces) - 1 if before >= self.length else self._piece(before)
        for x0, y0, ex, ey, begin, length in pieces[self._piece(after) : last + 1]:
            dx, dy = x - x0, y - y0
            along = dx * ex + dy * ey
            along = 0.0 if along < 0.0 else length if along > length else along
            dx, dy = dx - along * ex, dy - along * ey
            squared = dx * dx + dy * dy
            if squared < nearest:
                nearest, found = squared, (begin + along, ex * dy - ey * dx)
        return found[0], math.copysign(math.sqrt(nearest), found[1])

    def least_distance(self, x: float, y: float) -> float:
        """Return a distance [m] that a point has from the curve at least, at once: a detour by it is no shorter."""
        (x0, y0), (x1, y1) = self.points[0], self.points[-1]
        return (math.hypot(x - x0, y - y0) + math.hypot(x - x1, y - y1) - self.stations[-1]) / 2

    def between(self, start: float, end: float) -> Polyline:
        """Return the part from one station to another; ValueError where it has no length."""
        start, end = max(start, 0.0), min(end, self.length)
        inner = [p for p, s in zip(self.points, self.stations, strict=True) if start < s < end]
        return Polyline([self.pose_at(start)[:2], *inner, self.pose_at(end)[:2]])

    def resampled(self, spacing: float) -> Polyline:
        """Return the curve through points at most ``spacing`` apart, the ends kept."""
        pieces = max(1, math.ceil(self.length / spacing))
        return Polyline(self.pose_at(self.length * i / pieces)[:2] for i in range(pieces + 1))

    def __repr__(self) -> str:
        return f"Polyline({len(self.points)} points, {self.length:.2f} m)"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Polyline) and self.points == other.points

    def __hash__(self) -> int:
        return hash(self.points)
