"""Who may enter a junction: lights, stop signs, and gaps in the traffic that goes first."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tmpud.geometry import Polyline
from tmpud.motion.signals import SignalClock
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.scene import Scene, Vehicles

CLEARANCE = 2.4  # [m] two paths closer than this share the place
MARGIN = 1.5  # [s] between the ego leaving a shared place and another reaching it
FOE_SPEED = 6.0  # [m/s] that others may reach
FOE_HORIZON = 60.0  # [m] how far up the road others are looked for
LATE_BRAKING = 3.0  # [m/s^2] where more is needed to stop for yellow, the ego goes on
GENTLE, CROSSING_SPEED = 1.5, 4.5  # [m/s^2], [m/s] by which the ego counts on crossing a junction
IMPATIENCE = 120.0  # [s] after which the ego enters on any green
PATIENCE = 4.0  # [s] after which standing vehicles are taken to be waiting for the ego

ByLane = dict[str, list[int]]  # lane -> which of the others are on it


class Shared(NamedTuple):
    """Where two paths through a junction share a place: stations on the own and on the other path [m]."""

    enter: float
    leave: float
    other_enter: float
    other_leave: float


class RightOfWay:
    """Decides, for one stop line at a time, whether the ego may cross it now; what it remembers is its clock."""

    def __init__(self, network: RoadNetwork) -> None:
        self._network = network
        self.clock = SignalClock(network)
        self._shared: dict[tuple[int, int], Shared | None] = {}
        self._junctions: dict[str, list[int]] = defaultdict(list)

    def may_enter(self, scene: Scene, index: int, distance: float, standing: float) -> bool:
        """Return whether the ego, ``distance`` metres before the line, may go through connection ``index``.

        ``standing`` is for how long it has stood before this line [s].
        """
        connection = self._network.connections[index]
        letter = self._letter(scene, connection)
        if letter in "rRu" or (letter in "yY" and _can_stop(scene.ego.speed, distance)):
            return False
        if standing < IMPATIENCE and not self._clears_in_time(scene, connection, distance):
            return False
        if ((connection.signal is None and connection.priority in "sw") or letter == "s") and standing <= 0.0:
            return False
        yields = () if letter == "G" else connection.yields_to
        by_lane = _by_lane(scene.others)
        return not any(
            self._inside(scene, index, foe, by_lane, goes_first=foe in connection.yields_to)
            or (foe in yields and self._arriving(scene, index, foe, by_lane, distance, standing))
            for foe in connection.foes
        )

    def _clears_in_time(self, scene: Scene, connection: LaneConnection, distance: float) -> bool:
        """Whether the ego would be out of the junction before crossing traffic gets green, or is too near to stop."""
        way = distance + connection.path.length + scene.ego.length
        time = _time_to_cover(way, scene.ego.speed)
        left = self.clock.until_crossing_green(connection, scene.time)
        return time < left or not _can_stop(scene.ego.speed, distance)

    def observe(self, scene: Scene) -> None:
        """Watch the lights; to be called at every step."""
        self.clock.observe(scene)

    def room_inside(self, scene: Scene, index: int, front: float) -> float:
        """Return how far the ego, within connection ``index``, may go on before a place that another takes first [m].

        ``front`` is its bumper's station on the connection's path. Whoever is in a shared place, or on the move and at
        it before the ego, goes first, whatever the signs say: not all others wait for those who are still crossing.
        """
        own = self._network.connections[index]
        by_lane = _by_lane(scene.others)
        room = math.inf
        for other in self._same_junction(own):
            connection = self._network.connections[other]
            if connection.from_lane == own.from_lane or (shared := self.shared(index, other)) is None:
                continue
            to_place = shared.enter - front
            if to_place > 0.5:
                own_arrival = _time_to_cover(to_place, scene.ego.speed)
                if any(_is_first(*car, shared, own_arrival) for car in self._crossing(scene, connection, by_lane)):
                    room = min(room, to_place)
        return room

    def _same_junction(self, own: LaneConnection) -> list[int]:
        if not self._junctions:
            for index, connection in enumerate(self._network.connections):
                self._junctions[connection.junction].append(index)
        return self._junctions[own.junction]

    def _crossing(
        self, scene: Scene, connection: LaneConnection, by_lane: ByLane
    ) -> Iterator[tuple[float, float, float]]:
        """Yield rear and front station on the connection's path [m] and speed [m/s] of those who drive through it."""
        others = scene.others
        for lane in connection.internal_lanes:
            for i in by_lane.get(lane, ()):
                station = connection.path.project(float(others.x[i]), float(others.y[i]))[0]
                half = float(others.length[i]) / 2
                yield station - half, station + half, float(others.speed[i])

    def _letter(self, scene: Scene, connection: LaneConnection) -> str:
        """Return the state of the connection's light, "O" (off) where it has none."""
        return scene.signals[connection.signal][connection.link] if connection.signal else "O"

    def _inside(self, scene: Scene, index: int, foe: int, by_lane: ByLane, *, goes_first: bool) -> bool:
        """Whether a vehicle on a foe's path through the junction will be in the way."""
        shared = self.shared(index, foe)
        if shared is None:
            return False
        for rear, front, speed in self._crossing(scene, self._network.connections[foe], by_lane):
            waits = speed < 0.5 and front < shared.other_enter + 0.5
            if rear <= shared.other_leave and (goes_first or not waits):
                return True
        return False

    def _arriving(
        self,
        scene: Scene,
        index: int,
        foe: int,
        by_lane: ByLane,
        distance: float,
        standing: float,
    ) -> bool:
        """Whether a vehicle that goes first would reach the shared place before the ego has left it."""
        shared = self.shared(index, foe)
        connection = self._network.connections[foe]
        if shared is None or self._letter(scene, connection) in "rRu":
            return False
        ego = scene.ego
        cleared = _time_to_cover(max(distance, 0.0) + shared.leave + ego.length, ego.speed) + MARGIN
        for lane, to_line in self._upstream(connection.from_lane):
            for i in by_lane.get(lane, ()):
                speed = float(scene.others.speed[i])
                if standing > PATIENCE and speed < 0.3:
                    continue
                on_lane = self._network.lanes[lane].centre.project(float(scene.others.x[i]), float(scene.others.y[i]))
                way = to_line - on_lane[0] - float(scene.others.length[i]) / 2 + shared.other_enter
                if way / max(FOE_SPEED, speed) < cleared:
                    return True
        return False

    def _upstream(self, lane: str) -> Iterator[tuple[str, float]]:
        """Yield lanes that lead to a stop line, with the distance from each one's start to that line [m]."""
        queue = [(lane, self._network.lanes[lane].length)]
        while queue:
            lane, to_line = queue.pop()
            yield lane, to_line
            if to_line < FOE_HORIZON:
                queue += [
                    (before.from_lane, to_line + before.path.length + self._network.lanes[before.from_lane].length)
                    for before in self._network.incoming(lane)
                ]

    def shared(self, index: int, foe: int) -> Shared | None:
        """Return the place that two connections share, None where their paths keep apart."""
        if (index, foe) not in self._shared:
            connections = self._network.connections
            self._shared[index, foe] = _shared_place(connections[index].path, connections[foe].path)
        return self._shared[index, foe]


def _is_first(rear: float, front: float, speed: float, shared: Shared, own_arrival: float) -> bool:
    """Whether another on the move, or in the shared place already, has it before the ego."""
    if rear > shared.other_leave:
        return False
    if front > shared.other_enter:
        return True
    return speed > 0.5 and (shared.other_enter - front) / speed < own_arrival


def _by_lane(others: Vehicles) -> ByLane:
    found: dict[str, list[int]] = defaultdict(list)
    for i, lane in enumerate(others.lanes):
        found[lane].append(i)
    return found


def _can_stop(speed: float, distance: float) -> bool:
    return speed * speed / (2 * LATE_BRAKING) < distance


def _time_to_cover(way: float, speed: float) -> float:
    """Return how long the ego needs for some way when it speeds up gently [s]."""
    top = max(CROSSING_SPEED, speed)
    speeding_up = (top * top - speed * speed) / (2 * GENTLE)
    if way < speeding_up:
        return (math.sqrt(speed * speed + 2 * GENTLE * way) - speed) / GENTLE
    return (top - speed) / GENTLE + (way - speeding_up) / top


def _shared_place(own: Polyline, other: Polyline) -> Shared | None:
    first, second = own.resampled(0.5), other.resampled(0.5)
    a, b = np.array(first.points), np.array(second.points)
    close = np.hypot(a[:, None, 0] - b[:, 0], a[:, None, 1] - b[:, 1]) < CLEARANCE
    if not close.any():
        return None
    rows, columns = np.flatnonzero(close.any(axis=1)), np.flatnonzero(close.any(axis=0))
    return Shared(
        first.stations[int(rows[0])],
        first.stations[int(rows[-1])],
        second.stations[int(columns[0])],
        second.stations[int(columns[-1])],
    )
