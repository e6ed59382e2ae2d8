"""The path planner of P^m: from a transition to the shortest path that does it, and its length. No numpy."""

from __future__ import annotations

import math

from tmpud.motion.mapping import RoadPoint, StateMapping
from tmpud.motion.path import MERGE_LENGTH, Change, Cross, Move, find_path
from tmpud.roads.moves import END_ROOM, SHORTEST_MERGE
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Transition


class PathPlanner:
    """Finds paths between the poses of f on the lanes of a road network."""

    def __init__(self, network: RoadNetwork, mapping: StateMapping) -> None:
        self._network, self._mapping = network, mapping

    def path_length(self, transition: Transition) -> float:
        """Return A*(x, x') between f(s) and f(s') [m]; inf where no path does this action."""
        return self.path_length_from(self._mapping(transition.state), transition)

    def path_length_from(self, here: RoadPoint, transition: Transition) -> float:
        """Return A*(x, x') from where the ego is [m]; inf where no path does this action."""
        moves = self.moves(here, transition)
        return math.inf if moves is None else sum(move.length for move in moves)

    def lanes(self, transition: Transition) -> tuple[str, ...]:
        """Return the lanes the transition drives on, in order, those through junctions included."""
        moves = self.moves(self._mapping(transition.state), transition) or ()
        found: list[str] = []
        for move in moves:
            if isinstance(move, Cross):
                found += move.connection.internal_lanes
            else:
                found += [move.lane.id, move.target.id] if isinstance(move, Change) else [move.lane.id]
        return tuple(dict.fromkeys(found))

    def moves(self, here: RoadPoint, transition: Transition) -> tuple[Move, ...] | None:
        """Return the path from a point to x', None where there is none."""
        return find_path(self._network, here, self.goal(here, transition), transition.action)

    def goal(self, here: RoadPoint, transition: Transition) -> RoadPoint:
        """Return x' = f(s'); where lanes are not cut, a merge goes to the nearest pose that it can reach."""
        goal = self._mapping(transition.next_state)
        fixed = self._mapping.is_fixed(transition.next_state)
        if fixed or not (transition.action.is_merge and self._network.uncut):
            return goal
        part = self._network.open_from(here.lane, transition.action, here.station, SHORTEST_MERGE)
        begin = part.start if part else here.station
        lane = self._network.lanes[goal.lane]
        ratio = lane.length / self._network.lanes[here.lane].length
        if goal.station - begin * ratio >= SHORTEST_MERGE:
            return goal
        return RoadPoint(goal.lane, min((begin + MERGE_LENGTH) * ratio, lane.length - END_ROOM))
