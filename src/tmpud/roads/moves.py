"""What a car can do next on a road network: the moves from segment to segment, and what they connect."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from tmpud.roads.graph import Segment
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.symbols import Action

MERGES = (Action.MERGELEFT, Action.MERGERIGHT)
SHORTEST_MERGE = 20.0  # [m] of road that a car at 20 km/h needs to change lanes gently
END_ROOM = 3.0  # [m] kept free at the end of a lane that is not cut


class Move(NamedTuple):
    """An action and the segment to which it leads, or from which it comes."""

    action: Action
    segment: str


def moves(network: RoadNetwork, segment: str) -> Iterator[Move]:
    """Yield the moves from a segment: along its lane, to a neighbour's next segment, or through a junction."""
    ahead = network.ahead(segment)
    if ahead is None:
        for connection in _ways(network.outgoing(network.segments[segment].lane)):
            yield Move(connection.action, network.segments_of(connection.to_lane)[0].id)
    else:
        yield Move(Action.FORWARD, ahead.id)
    for action in MERGES:
        target = network.merge_target(segment, action)
        if target and _has_room(network, network.segments[segment], target, action):
            yield Move(action, target.id)


def moves_into(network: RoadNetwork, segment: str) -> Iterator[Move]:
    """Yield the moves that lead to a segment, each with the segment it comes from."""
    behind = network.behind(segment)
    if behind is None:
        for connection in _ways(network.incoming(network.segments[segment].lane)):
            yield Move(connection.action, network.segments_of(connection.from_lane)[-1].id)
    else:
        yield Move(Action.FORWARD, behind.id)
    for action in MERGES:
        origin = network.merge_origin(segment, action)
        if origin and _has_room(network, origin, network.segments[segment], action):
            yield Move(action, origin.id)


def _ways(connections: Iterable[LaneConnection]) -> Iterator[LaneConnection]:
    return (connection for connection in connections if not connection.turnaround)


def _has_room(network: RoadNetwork, origin: Segment, target: Segment, action: Action) -> bool:
    """Whether a merge has SHORTEST_MERGE: to the target's middle, or from the lane's middle to its end if uncut.

    Where cars may not change lanes everywhere, it has to be there from the last third of the segment on: no pose of
    the state lies further ahead.
    """
    way = target.end - origin.middle if network.uncut else target.middle - origin.middle
    if way < SHORTEST_MERGE:
        return False
    latest = origin.start + (origin.end - origin.start) * 2 / 3
    part = network.open_from(origin.lane, action, latest, SHORTEST_MERGE)
    if part is None or part == (latest, math.inf):
        return part is not None
    there = target.end - END_ROOM if network.uncut else target.middle
    there *= network.lanes[origin.lane].length / network.lanes[target.lane].length
    return min(part.end, there) - part.start >= SHORTEST_MERGE


def reachable(network: RoadNetwork, starts: Iterable[str]) -> set[str]:
    """Return the segments that can be driven to from any of some segments, these included."""
    found = set(starts)
    frontier = list(found)
    while frontier:
        for move in moves(network, frontier.pop()):
            if move.segment not in found:
                found.add(move.segment)
                frontier.append(move.segment)
    return found


def largest_strong_part(network: RoadNetwork) -> frozenset[str]:
    """Return the most segments of which each can be reached from every other; the first found of equally many."""
    graph = {segment: [move.segment for move in moves(network, segment)] for segment in network.segments}
    return max(strong_parts(graph), key=len, default=frozenset())


def strong_parts(graph: dict[str, list[str]]) -> Iterator[frozenset[str]]:
    """Yield the strongly connected components of a graph (Tarjan 1972, without recursion)."""
    seen: dict[str, int] = {}  # when a node was first met
    low: dict[str, int] = {}  # the earliest node on the stack that it leads back to
    stack: dict[str, None] = {}  # nodes whose component is not known yet, in the order they were met

    def enter(node: str) -> tuple[str, Iterator[str]]:
        seen[node] = low[node] = len(seen)
        stack[node] = None
        return node, iter(graph[node])

    for root in graph:
        work = [] if root in seen else [enter(root)]
        while work:
            node, successors = work[-1]
            fresh = next((successor for successor in successors if _note(successor, node, seen, low, stack)), None)
            if fresh is not None:
                work.append(enter(fresh))
                continue
            work.pop()
            if work:
                low[work[-1][0]] = min(low[work[-1][0]], low[node])
            if low[node] == seen[node]:
                yield frozenset(_pop_until(stack, node))


def _note(successor: str, node: str, seen: dict[str, int], low: dict[str, int], stack: dict[str, None]) -> bool:
    """Whether a successor is new; if it is one on the stack, note that the node leads back to it."""
    if successor in stack:
        low[node] = min(low[node], seen[successor])
    return successor not in seen


def _pop_until(stack: dict[str, None], node: str) -> Iterator[str]:
    top: str | None = None
    while top != node:
        top, _ = stack.popitem()
        yield top
