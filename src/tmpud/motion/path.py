"""The path planner (Sec. IV-C): A* over lanes, and the curve a car drives to change lanes."""

from __future__ import annotations

import heapq
import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

from tmpud.geometry import Point
from tmpud.motion.mapping import RoadPoint
from tmpud.roads.moves import SHORTEST_MERGE
from tmpud.roads.network import Lane, LaneConnection, RoadNetwork, Stretch
from tmpud.symbols import Action

MERGE_LENGTH = 25.0  # [m] of road that a lane change takes where there is room


class Follow(NamedTuple):
    """Keep to a lane's centre line."""

    lane: Lane
    start: float  # [m] station on the lane
    end: float

    @property
    def length(self) -> float:
        return self.end - self.start


class Cross(NamedTuple):
    """Go through a junction."""

    connection: LaneConnection

    @property
    def length(self) -> float:
        return self.connection.path.length


class Change(NamedTuple):
    """Swing from one lane to its neighbour over a stretch of road."""

    lane: Lane
    target: Lane
    start: float  # [m] station on ``lane``
    end: float

    @property
    def length(self) -> float:
        """Arc length of the curve, in ten chords."""
        points = outline(self, (self.end - self.start) / 10)
        return sum(math.dist(a, b) for a, b in itertools.pairwise(points))


Move = Follow | Cross | Change


def smoothstep(u: float) -> float:
    """Go from 0 to 1 without a jump in slope or curvature."""
    return u * u * u * (10 + u * (6 * u - 15))


def find_path(network: RoadNetwork, start: RoadPoint, goal: RoadPoint, action: Action) -> tuple[Move, ...] | None:
    """Return the shortest moves from one point to another that do one symbolic action, by A*; None if there are none.

    A merge changes lanes once; any other action changes none and crosses at most one junction. The heuristic is the
    straight line to the goal.
    """
    goal_x, goal_y, _ = network.lanes[goal.lane].centre.pose_at(goal.station)

    def estimate(at: RoadPoint) -> float:
        x, y, _ = network.lanes[at.lane].centre.pose_at(at.station)
        return math.hypot(goal_x - x, goal_y - y)

    queue: list[tuple[float, int, float, RoadPoint, tuple[Move, ...]]] = [(estimate(start), 0, 0.0, start, ())]
    pushed = 0
    while queue:
        _, _, driven, at, moves = heapq.heappop(queue)
        if at == goal and (moves or start == goal):
            return moves
        for move_list, to in _expand(network, at, goal, action, moves):
            length = driven + sum(move.length for move in move_list)
            pushed += 1
            heapq.heappush(queue, (length + estimate(to), pushed, length, to, moves + move_list))
    return None


def _expand(
    network: RoadNetwork, at: RoadPoint, goal: RoadPoint, action: Action, moves: tuple[Move, ...]
) -> Iterator[tuple[tuple[Move, ...], RoadPoint]]:
    """Yield what can be done next at a point: follow the lane to the goal, change lanes, cross a junction."""
    lane = network.lanes[at.lane]
    changed = any(isinstance(move, Change) for move in moves)
    if at.lane == goal.lane and goal.station > at.station and changed == action.is_merge:
        yield (Follow(lane, at.station, goal.station),), goal
    if action.is_merge and not changed:
        neighbour = network.neighbour(at.lane, action)
        part = network.open_from(at.lane, action, at.station, SHORTEST_MERGE)
        if neighbour is not None and part is not None:
            yield from _changes(lane, neighbour, at.station, part, goal)
    elif not action.is_merge and not moves:
        for connection in network.outgoing(at.lane):
            if connection.action is action:
                to = RoadPoint(connection.to_lane, 0.0)
                yield (Follow(lane, at.station, lane.length), Cross(connection)), to


def _changes(
    lane: Lane, target: Lane, station: float, part: Stretch, goal: RoadPoint
) -> Iterator[tuple[tuple[Move, ...], RoadPoint]]:
    """Yield the change from a lane to its neighbour within the part of the lane where it is allowed."""
    ratio = target.length / lane.length
    limit = goal.station / ratio if goal.lane == target.id else lane.length
    length = min(MERGE_LENGTH, limit - part.start, part.end - part.start)
    if length >= SHORTEST_MERGE:
        end = part.start + length
        at_goal = goal.lane == target.id and end >= limit - 1e-6
        before = (Follow(lane, station, part.start),) if part.start > station else ()
        yield (*before, Change(lane, target, part.start, end)), goal if at_goal else RoadPoint(target.id, end * ratio)


def outline(move: Move, spacing: float = 1.0) -> list[Point]:
    """Return points along one move, in driving order, at most ``spacing`` metres apart on a lane change."""
    if isinstance(move, Cross):
        return list(move.connection.path.points)
    if isinstance(move, Follow):
        if move.length < 1e-6:
            return [move.lane.centre.pose_at(move.start)[:2]]
        return list(move.lane.centre.between(move.start, move.end).points)
    pieces = math.ceil((move.end - move.start) / spacing)
    ratio = move.target.length / move.lane.length
    points = []
    for i in range(pieces + 1):
        station = move.start + (move.end - move.start) * i / pieces
        x0, y0, _ = move.lane.centre.pose_at(station)
        x1, y1, _ = move.target.centre.pose_at(station * ratio)
        share = smoothstep(i / pieces)
        points.append((x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
    return points
