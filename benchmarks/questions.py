"""What every planner is asked: the cheapest way between two segments, after one transition's Safe has fallen."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from tmpud.errors import NoPlanError
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import TMPUD
from tmpud.roads import RoadNetwork
from tmpud.symbols import Cost, LazyCost, OptimisticSafe, Place, Safe, ServiceRequest, State
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.domain import Domain

UNSAFE = 0.5  # Safe of the transition that was estimated


@dataclass(frozen=True, slots=True)
class Graph:
    """The segments of a map as numbered nodes, and the transitions between them, sorted by where they begin."""

    network: RoadNetwork
    cost: Cost  # [m], worked out already
    index: dict[str, int]  # segment -> node
    edges: dict[tuple[int, int], int]  # (from, to) -> number of the edge
    weights: tuple[int, ...]  # [cm] of the edges where every Safe is 1


@dataclass(frozen=True, slots=True)
class Question:
    """One request, and the transition of its first plan that turned out less safe."""

    request: ServiceRequest
    state: State  # where the plan is to start
    safe: Safe
    start: int
    goal: int
    edge: int
    weight: int  # [cm] of that edge now
    actions: int  # of the best plan now


def graph_of(network: RoadNetwork) -> Graph:
    """Work out every transition's Cost."""
    anywhere = _request(*islice(network.segments, 2))
    domain = Domain(network, anywhere)
    cost = LazyCost(PathPlanner(network, StateMapping(network, anywhere, TMPUD)).path_length)
    index = {segment: node for node, segment in enumerate(network.segments)}
    cheapest: dict[tuple[int, int], int] = {}
    for segment in index:
        for step in domain.successors(State(segment, 0)):
            if cost[step] < math.inf:
                ends = index[segment], index[step.next_state.segment]
                cheapest[ends] = min(weight(cost[step], 1.0), cheapest.get(ends, 2**31))
    pairs = sorted(cheapest)
    return Graph(network, cost, index, {ends: n for n, ends in enumerate(pairs)}, tuple(cheapest[p] for p in pairs))


def weight(cost: float, safe: float) -> int:
    """Return the utility of Sec. III [cm], with the default preset's gamma and no constant term."""
    penalty = TMPUD.gamma / (1 + math.exp(safe - 1)) - TMPUD.gamma / 2
    return round((cost + penalty) * 100)


def draw(graph: Graph, rng: random.Random, longest: int | None = None, goals: int | None = None) -> Iterator[Question]:
    """Yield questions about random pairs of segments, those whose best plan has more actions than ``longest`` left out.

    The first action of the first plan is the one whose Safe falls, as in a drive that estimates before it acts. The
    pairs have only so many ``goals``, where a number is given: cars under way to the same few places.
    """
    segments, planner = list(graph.index), AspPlanner(graph.network)
    shared = [_request(*rng.sample(segments, 2)) for _ in range(goals or 0)]
    while True:
        start, goal = rng.sample(segments, 2)
        request = rng.choice(shared) if shared else _request(start, goal)
        state, safe = State(start, request.leg_after(start, 0)), OptimisticSafe()
        try:
            step = planner.plan(state, request, graph.cost, safe)[0]
        except (NoPlanError, IndexError):
            continue
        safe[step] = UNSAFE
        actions = len(planner.plan(state, request, graph.cost, safe))
        if longest is None or actions <= longest:
            ends = graph.index[start], graph.index[step.next_state.segment]
            end, changed = graph.index[request.goals[0].segments[0]], weight(graph.cost[step], UNSAFE)
            yield Question(request, state, safe, ends[0], end, graph.edges[ends], changed, actions)


def _request(start: str, goal: str) -> ServiceRequest:
    return ServiceRequest(Place(start, (start,)), (Place(goal, (goal,)),))
