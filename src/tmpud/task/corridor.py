"""What makes the planner fast: the corridor, the few transitions that can lie on an optimal plan.

Safe starts at its best value and Cost does not fall below its first one, so the distances to the goal under the
first weights stay lower bounds. They guide A* to the optimum under the present weights; what cannot lie on a plan
of that rank is left out. No optimal plan is lost, ties included.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import NamedTuple

from tmpud.presets import Preset
from tmpud.symbols import Cost, OptimisticSafe, State, Transition
from tmpud.task.domain import Domain
from tmpud.task.utility import FORBIDDEN, Utility, split


class Exit(NamedTuple):
    """A transition out of a state, and what the first weights say of it."""

    through: int  # rank of the best plan from the state on that begins with it
    rank: int
    transition: Transition


@dataclass(frozen=True, slots=True)
class Tree:
    """The first weights, and how well every transition leads to the goal under them."""

    floor: dict[Transition, float]  # [m] the first Cost of each transition
    exits: dict[State, list[Exit]]  # those that lead to the goal, the best first

    def out_of(self, state: State) -> Sequence[Exit]:
        return self.exits.get(state, ())

    def bounds(self, cost: Cost) -> bool:
        """Whether no Cost is below its first value."""
        return all(cost[transition] >= first for transition, first in self.floor.items())


@dataclass(frozen=True, slots=True)
class Search:
    """A graph to find plans in, and its present weights, none of which is below the first one."""

    out_of: Callable[[State], Sequence[Exit]]  # a Tree's, of which some may be left out
    utility: Utility
    last: int  # the leg of the goal states


Stretch = tuple[Transition, ...]  # one way from a state to another, with no choice in between


@dataclass(frozen=True, slots=True)
class Corridor:
    """The transitions that can lie on a best plan, and what is known about them."""

    ranks: dict[Transition, int]
    distance: dict[State, int]  # rank of the best way from the start; all goals are as near as the nearest
    optimum: int  # rank of the best plan

    def stretches(self, start: State) -> list[Stretch]:
        """Return the transitions, joined wherever a state's only way in meets its only way out."""
        out: dict[State, list[Transition]] = {}
        ways_in = {start: 2}  # nothing is joined there
        for transition in self.ranks:
            out.setdefault(transition.state, []).append(transition)
            ways_in[transition.next_state] = ways_in.get(transition.next_state, 0) + 1
        joints = {state for state, ways in out.items() if len(ways) == 1 and ways_in.get(state) == 1}
        found = []
        for first in (way for state, ways in out.items() if state not in joints for way in ways):
            stretch = [first]
            while stretch[-1].next_state in joints:
                stretch += out[stretch[-1].next_state]
            found.append(tuple(stretch))
        return found

    def reduced(self, way: Stretch) -> tuple[int, int, int]:
        """Return a way's centimetres, merges and actions, less those by which its end is further from the start.

        Every plan's total shrinks by the optimum. The best plans then total 0, where the solver starts.
        """
        distance = self.distance
        own = split(sum(self.ranks[step] for step in way))
        here, there = split(distance[way[0].state]), split(distance[way[-1].next_state])
        return own[0] + here[0] - there[0], own[1] + here[1] - there[1], own[2] + here[2] - there[2]

    def optimal_transitions(self) -> set[Transition]:
        """Return the union of all best plans."""
        into: dict[State, list[Transition]] = {}
        for transition, rank in self.ranks.items():
            if self.distance[transition.state] + rank == self.distance[transition.next_state]:
                into.setdefault(transition.next_state, []).append(transition)
        ahead = [t.next_state for row in into.values() for t in row if self.distance[t.next_state] == self.optimum]
        union: set[Transition] = set()
        while ahead:
            new = set(into.get(ahead.pop(), ())) - union
            union |= new
            ahead.extend(transition.state for transition in new)
        return union


def backward_tree(domain: Domain, preset: Preset, cost: Cost) -> Tree:
    """Return how well every transition leads to the goal under Cost and Safe = 1 (Dijkstra)."""
    floor: dict[Transition, float] = {}
    exits: dict[State, list[Exit]] = {}
    first = Utility(preset, cost, OptimisticSafe(), floor)
    distance = dict.fromkeys(domain.goal_states(), 0)
    queue = [(0, state) for state in distance]
    while queue:
        here, state = heappop(queue)
        if here > distance[state]:
            continue
        for transition in domain.predecessors(state):
            if transition in floor:
                continue
            floor[transition] = cost[transition]
            rank = first.rank(transition)
            if rank < FORBIDDEN:
                there = here + rank
                exits.setdefault(transition.state, []).append(Exit(there, rank, transition))
                if there < distance.get(transition.state, FORBIDDEN):
                    distance[transition.state] = there
                    heappush(queue, (there, transition.state))
    for row in exits.values():
        row.sort()
    return Tree(floor, exits)


def corridor(search: Search, start: State, limit: int | None = None) -> Corridor | None:
    """Return the transitions that lie on a way of at most this rank from the start to a goal; None where none does.

    A transition's way is the best one to it under the present weights, and from it on under the first ones. The limit
    is by default the rank of the best plan, which A* finds. A state's exits wait for their turn one by one, with the
    rank of their ways (Enhanced Partial Expansion A*, Goldenberg et al. 2014): most are never looked at.
    """
    utility, last = search.utility, search.last
    distance, goals, touched = {start: 0}, list[State](), list[tuple[int, int, Transition]]()
    optimum, widest = FORBIDDEN if start.leg < last else 0, FORBIDDEN - 1 if limit is None else limit
    waiting, estimates = defaultdict[int, list[tuple[int, State, Sequence[Exit], int]]](list), list[int]()

    def wait(here: int, state: State, exits: Sequence[Exit], n: int) -> None:
        if n < len(exits):
            estimate = here + exits[n].through
            if estimate not in waiting:
                heappush(estimates, estimate)
            waiting[estimate].append((here, state, exits, n))

    wait(0, start, search.out_of(start), 0)
    while estimates and (estimate := heappop(estimates)) <= widest:
        for here, state, exits, n in waiting[estimate]:  # exits as good as these join them, never better ones
            if here > distance[state]:
                continue
            wait(here, state, exits, n + 1)
            _, first, transition = exits[n]
            rank = first if utility.unchanged(transition) else utility.rank(transition)
            following, there, onward = transition.next_state, here + rank, estimate - first + rank
            if onward > widest:
                continue
            touched.append((onward, rank, transition))
            if there < distance.get(following, FORBIDDEN):
                distance[following] = there
                if following.leg < last:
                    wait(there, following, search.out_of(following), 0)
                else:
                    goals.append(following)
                    optimum = min(optimum, there)
                    widest = optimum if limit is None else limit
    if optimum == FORBIDDEN:
        return None
    ranks = {transition: rank for onward, rank, transition in touched if onward <= widest}
    return Corridor(ranks, distance | dict.fromkeys(goals, optimum), optimum)


def whole_map(domain: Domain, utility: Utility, start: State) -> Corridor:
    """Return all that can be driven from the start on, nothing left out, with no distances."""
    ranks, distance, ahead = dict[Transition, int](), {start: 0}, [start]
    while ahead:
        for transition in domain.successors(ahead.pop()):
            rank = utility.rank(transition)
            if rank < FORBIDDEN:
                ranks[transition] = rank
                if transition.next_state not in distance:
                    distance[transition.next_state] = 0
                    ahead.append(transition.next_state)
    return Corridor(ranks, distance, 0)
