"""The agreed meaning of states, actions and quality once more, written as plainly as possible."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product

import networkx

from tmpud.presets import Preset
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action, ServiceRequest, State, TaskPlan, Transition

Triple = tuple[int, int, int]
Weights = Mapping[Transition, int]  # [cm] of the transitions that can be driven


def moves(network: RoadNetwork) -> set[tuple[str, Action, str]]:
    """Return (segment, action, segment) wherever the map allows it, legs and costs aside."""
    found = set()
    for here, there in product(network.segments.values(), network.segments.values()):
        a, b = network.lanes[here.lane], network.lanes[there.lane]
        if a.edge == b.edge and there.number == here.number + 1:
            if a.index == b.index:
                found.add((here.id, Action.FORWARD, there.id))
            if b.index == a.index + 1 and a.change_left:
                found.add((here.id, Action.MERGELEFT, there.id))
            if b.index == a.index - 1 and a.change_right:
                found.add((here.id, Action.MERGERIGHT, there.id))
    for connection in network.connections:
        if not connection.turnaround:
            before, after = network.segments_of(connection.from_lane)[-1], network.segments_of(connection.to_lane)[0]
            found.add((before.id, connection.action, after.id))
    return found


def arrive(request: ServiceRequest, segment: str, leg: int) -> int:
    """Return the leg after arriving on a segment."""
    goals = request.goals
    if leg < len(goals) and segment in goals[leg].segments:
        leg += 1
        while leg < len(goals) and goals[leg].station is None and segment in goals[leg].segments:
            leg += 1
    return leg


def transitions(network: RoadNetwork, request: ServiceRequest) -> set[Transition]:
    """Return every transition of every state."""
    found = set()
    for (origin, action, target), leg in product(moves(network), range(len(request.goals))):
        found.add(Transition(State(origin, leg), action, State(target, arrive(request, target, leg))))
    for leg, goal in enumerate(request.goals):
        if goal.station is not None:
            (segment,) = goal.segments
            state = State(segment, leg)
            found.add(Transition(state, Action.FORWARD, State(segment, arrive(request, segment, leg))))
    return found


def weight(transition: Transition, cost: float, safe: float, preset: Preset) -> int:
    """Return the objective of Sec. III [cm]."""
    penalty = preset.gamma / (1 + math.exp(safe - 1)) - (0 if preset.constant_term else preset.gamma / 2)
    turn = preset.turn_cost if transition.action in (Action.TURNLEFT, Action.TURNRIGHT) else 0
    return round((cost + penalty + turn) * 100)


def triple(plan: TaskPlan, weights: Weights) -> Triple:
    return sum(weights[step] for step in plan), sum(step.action.is_merge for step in plan), len(plan)


def order(plan: TaskPlan) -> tuple[tuple[bool, str, str], ...]:
    """Return what orders plans of one triple: at the first difference a merge, then the smaller segment, wins."""
    return tuple((not step.action.is_merge, step.next_state.segment, step.action.value) for step in plan)


def dijkstra(start: State, last: int, weights: Weights) -> Triple | None:
    """Return the triple of the best plan, by networkx."""
    graph = networkx.DiGraph()
    graph.add_node(start)
    for step, centimetres in weights.items():
        packed = centimetres * 10**12 + step.action.is_merge * 10**6 + 1
        known = graph.get_edge_data(step.state, step.next_state, {"weight": packed})["weight"]
        graph.add_edge(step.state, step.next_state, weight=min(packed, known))
    lengths = networkx.single_source_dijkstra_path_length(graph, start)
    best = min((length for state, length in lengths.items() if state.leg == last), default=None)
    return None if best is None else (best // 10**12, best // 10**6 % 10**6, best % 10**6)


def simple_plans(start: State, last: int, weights: Weights, budget: int) -> list[TaskPlan] | None:
    """Return every plan that visits no state twice; None where looking for them takes more than ``budget`` steps."""
    leaving: dict[State, list[Transition]] = {}
    for step in weights:
        leaving.setdefault(step.state, []).append(step)
    found: list[TaskPlan] = []
    open_plans: list[tuple[TaskPlan, State, frozenset[State]]] = [((), start, frozenset((start,)))]
    while open_plans and budget:
        budget -= 1
        plan, state, visited = open_plans.pop()
        if state.leg == last:
            found.append(plan)
            continue
        steps = (step for step in leaving.get(state, ()) if step.next_state not in visited)
        open_plans.extend(((*plan, step), step.next_state, visited | {step.next_state}) for step in steps)
    return None if open_plans else found
