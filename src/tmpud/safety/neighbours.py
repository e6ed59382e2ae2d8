"""Which surrounding vehicles the estimate looks at: the V_i of Algorithm 1."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tmpud.presets import Preset
from tmpud.roads.network import RoadNetwork
from tmpud.scene import ComplexArray, FloatArray, Scene, Vehicles
from tmpud.symbols import Transition
from tmpud.trajectory import Trajectory, predict

Mask = NDArray[np.bool_]

LEVEL = 3.0  # [m] vehicles this far above or below are on another level
SIDE_GAP = 0.5  # [m] free space between two boxes below which their paths conflict
PATH_INTERVAL = 0.25  # [s] longest step at which paths are compared: cars must not pass between two instants


def perceived(preset: Preset, network: RoadNetwork, transition: Transition, scene: Scene) -> Vehicles:
    """Return the vehicles within the preset's range, heading, level and lane."""
    ego, others = scene.ego, scene.others
    distance = np.hypot(others.x - ego.pose.x, others.y - ego.pose.y)
    turned = np.abs(np.angle(np.exp(1j * (others.heading - ego.pose.heading))))
    keep = (distance <= preset.sensing_range) & (np.abs(others.z - ego.z) < LEVEL)
    keep &= turned <= preset.neighbour_heading + 1e-9
    if preset.neighbours == "target lane":
        keep &= _on(others, {network.segments[transition.next_state.segment].lane})
    return others.take(keep)


def conflicting(others: Vehicles, ego_lane: str, path: tuple[str, ...], network: RoadNetwork) -> Vehicles:
    """Leave out the vehicles that the ego follows or that follow it on its own path: car-following governs them."""
    return others.take(~_on(others, {ego_lane, *path, *_feeding(ego_lane, network)}))


def crossing(others: Vehicles, ego: Trajectory, ego_width: float) -> Vehicles:
    """Return the vehicles whose predicted path comes sideways within ``SIDE_GAP`` of the ego's planned path."""
    end = ego.times[-1]
    times = np.linspace(0.0, end, max(math.ceil(end / PATH_INTERVAL), 1) + 1)
    distance = _distance(predict(others, times).places, ego.places).min(axis=1)
    return others.take(distance <= (others.width + ego_width) / 2 + SIDE_GAP)


def _on(others: Vehicles, lanes: set[str]) -> Mask:
    return np.array([lane in lanes for lane in others.lanes], dtype=np.bool_)


def _feeding(lane: str, network: RoadNetwork) -> set[str]:
    """Return the lanes that lead into the lane the ego is already on; who is there can only follow it."""
    if lane in network.internal:
        return {network.connections[network.internal[lane]].from_lane}
    ways = network.incoming(lane) if lane in network.lanes else []
    return {feeder for way in ways for feeder in (way.from_lane, *way.internal_lanes)}


def _distance(points: ComplexArray, path: ComplexArray) -> FloatArray:
    """Return the distances (N, K) of points from a path through T points [m]."""
    starts = path[:-1] if len(path) > 1 else path
    pieces = np.diff(path) if len(path) > 1 else np.zeros_like(path)
    offset = points[:, :, None] - starts  # (N, K, T - 1)
    squared = np.maximum(np.abs(pieces) ** 2, 1e-12)
    along = np.clip((offset * np.conj(pieces)).real / squared, 0.0, 1.0)
    return np.asarray(np.abs(offset - along * pieces).min(axis=2))
