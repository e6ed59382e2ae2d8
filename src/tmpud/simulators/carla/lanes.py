"""On which lane a vehicle is: the server says where cars are, not on which of the map's lanes."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator
from functools import partial

import numpy as np

from tmpud.geometry import Polyline, Pose
from tmpud.roads.network import RoadNetwork
from tmpud.scene import FloatArray

SPACING = 2.0  # [m] between samples of a lane's centre line
CELL = 5.0  # [m]
BESIDE, ASKEW, LEVEL = 2.5, math.radians(75.0), 3.0  # [m], [rad], [m] beyond which a vehicle is not on a lane
PER_RADIAN = 2.0  # [m] that a heading off by one radian counts
PREFERRED = 0.5  # [m] that a lane a vehicle is expected on may be further away than another


class LaneFinder:
    """All lanes of a map, those through junctions included, by what is near a point."""

    def __init__(self, network: RoadNetwork) -> None:
        names, rows = [], []
        for name, centre, elevation in _centre_lines(network):
            steps = max(math.ceil(centre.length / SPACING), 1)
            for station in np.linspace(0.0, centre.length, steps + 1).tolist():
                names.append(name)
                rows.append((*centre.pose_at(station), elevation(station)))
        self._names, self._samples = names, np.array(rows).reshape(-1, 4)
        cells: dict[tuple[int, int], list[int]] = defaultdict(list)
        for i, (x, y) in enumerate(self._samples[:, :2].tolist()):
            column, row = _cell(x, y)
            for dx in (-1, 0, 1):
                for dy in (-1, 0, 1):
                    cells[column + dx, row + dy].append(i)
        self._cells = {cell: np.array(found) for cell, found in cells.items()}

    def lane(self, pose: Pose, z: float, expected: Collection[str] = ()) -> str:
        """Return the lane that a vehicle is on, "" where it is on none; an expected one where others are as near."""
        near = self._cells.get(_cell(pose.x, pose.y))
        if near is None:
            return ""
        away = self._distances(near, pose, z)
        best, found = math.inf, ""
        for i in np.flatnonzero(np.isfinite(away)).tolist():
            name = self._names[near[i]]
            distance = away[i] - (PREFERRED if name in expected else 0.0)
            if distance < best:
                best, found = distance, name
        return found

    def _distances(self, near: FloatArray, pose: Pose, z: float) -> FloatArray:
        """Return how far beside samples a vehicle is [m], and askew; inf where it is not on their lanes."""
        x, y, heading, level = self._samples[near].T
        dx, dy = pose.x - x, pose.y - y
        cos, sin = np.cos(heading), np.sin(heading)
        along, beside = np.abs(dx * cos + dy * sin), np.abs(dy * cos - dx * sin)
        askew = np.abs((heading - pose.heading + math.pi) % (2 * math.pi) - math.pi)
        there = (along <= SPACING) & (beside < BESIDE) & (askew < ASKEW) & (np.abs(level - z) < LEVEL)
        return np.where(there, beside + PER_RADIAN * askew, np.inf)


def _centre_lines(network: RoadNetwork) -> Iterator[tuple[str, Polyline, Callable[[float], np.float64]]]:
    for lane in network.lanes.values():
        yield lane.id, lane.centre, partial(np.interp, xp=lane.centre.stations, fp=lane.elevation)
    for way in network.connections:
        ends = [network.lanes[way.from_lane].elevation[-1], network.lanes[way.to_lane].elevation[0]]
        if way.internal_lanes and way.path.length > 0.0:
            yield way.internal_lanes[0], way.path, partial(np.interp, xp=[0.0, way.path.length], fp=ends)


def _cell(x: float, y: float) -> tuple[int, int]:
    return math.floor(x / CELL), math.floor(y / CELL)
