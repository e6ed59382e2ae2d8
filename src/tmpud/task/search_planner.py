"""P^t without the proof: A* on the kept tree, for where many thousands of plans are made on one map.

It searches the graph, weights and ties of ``AspPlanner``, whose answer it equals; ``prove`` asks clingo for the same.
"""

from __future__ import annotations

from tmpud.errors import NoPlanError
from tmpud.presets import TMPUD, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Cost, Safe, ServiceRequest, State
from tmpud.task.asp_planner import AspPlanner, PlanReport, report_of
from tmpud.task.corridor import corridor
from tmpud.task.ties import walk


class SearchPlanner(AspPlanner):
    """The TaskPlanner that searches; its plans are not marked as proved. It cannot keep a user's rules."""

    def __init__(self, network: RoadNetwork, preset: Preset = TMPUD) -> None:
        super().__init__(network, preset)

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        """Return the best plan and its terms; raises NoPlanError or RequestError."""
        search = self._search(state, request, cost, safe)
        if state.leg == search.last:
            return report_of((), search.utility)
        found = corridor(search, state)
        if found is None:
            raise NoPlanError(f"no plan leads from {state.segment} to {request.goals[-1].name}")
        return report_of(walk(state, found.optimal_transitions()), search.utility)

    def prove(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        """Return clingo's plan under the same weights; raises as ``AspPlanner.solve`` does."""
        return AspPlanner.solve(self, state, request, cost, safe)
