"""The task domain as a transition system: lane segments, the five actions, goals in their order (Sec. IV-C)."""

from __future__ import annotations

from collections.abc import Iterator

from tmpud.errors import RequestError
from tmpud.roads.moves import moves, moves_into
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition


class Domain:
    """The states and transitions of one request on one map, worked out when they are first asked for."""

    def __init__(self, network: RoadNetwork, request: ServiceRequest) -> None:
        """Raise RequestError where a place names a segment that the map does not have."""
        if not request.goals:
            raise RequestError(f"{request.start.name}: a request needs at least one goal")
        self.network, self.request = network, request
        self.last = len(request.goals)  # the leg in which nothing is left to do
        for place in (request.start, *request.goals):
            _check(place, network)
        self._goals = tuple(frozenset(goal.segments) for goal in request.goals)
        self._successors: dict[State, tuple[Transition, ...]] = {}

    def start_state(self) -> State:
        """Return the state a drive begins in: goals that the start itself reaches are done."""
        return self.request.start_state()

    def check(self, state: State) -> None:
        """Raise RequestError where a state is not one of this domain."""
        if state.segment not in self.network.segments or not 0 <= state.leg <= self.last:
            raise RequestError(
                f"{state.segment}, leg {state.leg}: not a state of the drive from {self.request.start.name}"
            )

    def goal_states(self) -> tuple[State, ...]:
        return tuple(State(segment, self.last) for segment in self.request.goals[-1].segments)

    def is_goal(self, state: State) -> bool:
        return state.leg == self.last

    def successors(self, state: State) -> tuple[Transition, ...]:
        """Return the transitions out of a state; Cost says which of them can be driven."""
        known = self._successors.get(state)
        if known is None:
            known = self._successors[state] = tuple(dict.fromkeys(self._leaving(state)))
        return known

    def predecessors(self, state: State) -> Iterator[Transition]:
        """Yield the transitions into a state; one may come twice."""
        segment, leg = state
        for before in range(min(leg + 1, self.last)):
            if self.leg_after(segment, before) == leg:
                for action, origin in moves_into(self.network, segment):
                    yield Transition(State(origin, before), action, state)
                if self._at_position(segment, before):
                    yield Transition(State(segment, before), Action.FORWARD, state)

    def leg_after(self, segment: str, leg: int) -> int:
        """Return the leg that arriving on a segment in some leg leads to."""
        return self.request.leg_after(segment, leg)

    def _at_position(self, segment: str, leg: int) -> bool:
        """Whether the leg's goal is a position on the segment: it may be reached by driving on within it."""
        return self.request.goals[leg].station is not None and segment in self._goals[leg]

    def _leaving(self, state: State) -> Iterator[Transition]:
        segment, leg = state
        if self.is_goal(state):
            return
        if self._at_position(segment, leg):
            yield Transition(state, Action.FORWARD, State(segment, self.leg_after(segment, leg)))
        for action, target in moves(self.network, segment):
            yield Transition(state, action, State(target, self.leg_after(target, leg)))


def _check(place: Place, network: RoadNetwork) -> None:
    unknown = [segment for segment in place.segments if segment not in network.segments]
    if unknown or not place.segments:
        missing = f"segment {unknown[0]!r} is not on the map {network.name}" if unknown else "it has no segment"
        raise RequestError(f"{place.name}: {missing}")
    if place.station is not None and len(place.segments) != 1:
        raise RequestError(f"{place.name}: a position lies on one segment, not on {len(place.segments)}")
