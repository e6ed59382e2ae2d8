"""The state mapping function f (Sec. III): from a symbolic state to a pose on the road."""

from __future__ import annotations

import random
from typing import NamedTuple

from tmpud.geometry import Pose
from tmpud.presets import Preset
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import ServiceRequest, State


class RoadPoint(NamedTuple):
    """A point on a lane's centre line."""

    lane: str
    station: float  # [m] from the lane's start


class StateMapping:
    """f(s): one pose for every state, on the centre line of its segment.

    The start and goals that name a position are at that position. Any other state is at its segment's middle, or,
    where the preset samples poses, at a seeded point of the segment's middle third, from where every action of
    the state can still be driven.
    """

    def __init__(self, network: RoadNetwork, request: ServiceRequest, preset: Preset, seed: int = 0) -> None:
        self.network = network
        self._sampled = preset.pose == "sampled"
        self._seed = seed
        self._fixed = request.positions()

    def __call__(self, state: State) -> RoadPoint:
        """Return where the centre of the ego's box is in a state."""
        segment = self.network.segments[state.segment]
        if state in self._fixed:
            return RoadPoint(segment.lane, self._fixed[state])
        if not self._sampled:
            return RoadPoint(segment.lane, segment.middle)
        share = random.Random(f"{self._seed}/{state.segment}").uniform(1 / 3, 2 / 3)  # noqa: S311
        return RoadPoint(segment.lane, segment.start + share * (segment.end - segment.start))

    def is_fixed(self, state: State) -> bool:
        """Whether the request names the position of a state."""
        return state in self._fixed

    def pose(self, state: State) -> Pose:
        """Return f(s) as a pose in the map's frame."""
        lane, station = self(state)
        return self.network.lanes[lane].centre.pose_at(station)
