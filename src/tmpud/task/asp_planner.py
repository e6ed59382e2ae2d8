"""P^t: the task planner of Sec. IV-C, by answer set programming.

What does what: Python looks up the weights, leaves out transitions that cannot lie on an optimal plan (``corridor.py``;
``prune=False`` leaves out nothing) and joins those that leave no choice. clingo decides: it makes the plans of what is
left, proves the least (centimetres, merges, actions), and returns the union of all plans that have it. Whichever way
one walks along it, the plan is optimal; the walk takes the earliest merge, then the smallest lane id (``ties.py``).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tmpud.errors import NoPlanError, UtilityOverflowError
from tmpud.presets import TMPUD, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.showing import ShownAsHtml
from tmpud.symbols import Cost, Safe, ServiceRequest, State, TaskPlan
from tmpud.task.alternatives import best_plans
from tmpud.task.corridor import Search, Tree, backward_tree, corridor, whole_map
from tmpud.task.domain import Domain
from tmpud.task.explain import explain
from tmpud.task.facts import facts
from tmpud.task.proof import Prover
from tmpud.task.ties import walk
from tmpud.task.utility import Terms, Utility, split

if TYPE_CHECKING:
    from tmpud.task.rules import Rules

REMEMBERED = 16  # requests


@dataclass(frozen=True, slots=True)
class PlanReport(ShownAsHtml):
    """A plan, what it costs term by term, and how it was found."""

    plan: TaskPlan
    cost_m: float  # [m] length driven
    penalty_m: float  # [m] the safety term
    turns_m: float  # [m] added for turns
    total_cm: int  # [cm] what was minimised: the sum for each transition, rounded once
    optimal: bool  # proved
    rules_m: float = 0.0  # [m] added by the user's rules
    transitions: int = 0  # of the corridor
    rounds: int = 0  # corridors that were tried
    ground_s: float = field(default=0.0, compare=False)  # [s] wall-clock
    solve_s: float = field(default=0.0, compare=False)  # [s] wall-clock
    steps: tuple[Terms, ...] = ()  # of each transition


@dataclass(slots=True)
class _Memory:
    """What is kept of a request from one plan to the next."""

    domain: Domain
    tree: Tree
    cost: Cost  # the mapping whose values the tree was last compared with


class AspPlanner:
    """The TaskPlanner that proves its plans; it remembers the distances to the goals of the last requests."""

    def __init__(
        self,
        network: RoadNetwork,
        preset: Preset = TMPUD,
        *,
        prune: bool = True,
        conflicts: int | None = None,
        rules: Rules | None = None,
    ) -> None:
        """Take ``conflicts`` as the solver's limit, after which it gives the best plan it has, unproved.

        ``rules`` are a user's own (``task.rules``): every plan keeps them, whatever state it starts from. Raises
        RulesError where they name what is not on the map.
        """
        self.network, self.preset = network, preset
        if rules:
            rules.check(network)
        options = () if conflicts is None else (f"--solve-limit={conflicts}",)
        self._prover = Prover(prune, rules, options)
        self._memory: dict[ServiceRequest, _Memory] = {}

    def plan(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> TaskPlan:
        """Return the optimal plan; raises NoPlanError where there is none."""
        return self.solve(state, request, cost, safe).plan

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        """Return the optimal plan and its terms; raises NoPlanError, RequestError or UtilityOverflowError.

        As long as ``cost`` is the same mapping, a Cost that fell below its first value counts as that first value,
        unless the preset updates Cost to the current pose's.
        """
        search = self._search(state, request, cost, safe)
        utility = search.utility
        if state.leg == search.last:
            return report_of((), utility, optimal=True)
        domain, rules = self._memory[request].domain, self._prover.rules
        proof = self._prover.prove(domain, search, state)
        if proof is None or not proof.union:
            if rules and corridor(search, state):
                raise NoPlanError(f"no plan keeps the rules of {rules.source}; without them there is one")
            raise NoPlanError(explain(domain, state, utility.rank))
        plan = walk(state, proof.union)
        terms, total, steps = utility.total(plan)
        added = proof.centimetres - total
        if added and rules is None:
            raise UtilityOverflowError(f"the solver's total is not the plan's: {total} cm")
        sizes, times = (proof.transitions, proof.rounds), (proof.ground_s, proof.solve_s)
        return PlanReport(plan, *terms, total, proof.optimal, added / 100.0, *sizes, *times, steps)

    def instance(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> str:
        """Return the facts that, with the package's .lp files, make plain ``clingo`` find the same optimum."""
        search, domain = self._search(state, request, cost, safe), self._memory[request].domain
        given = corridor(search, state) if self._prover.prune else whole_map(domain, search.utility, state)
        weights = {transition: split(rank)[0] for transition, rank in given.ranks.items()} if given else {}
        return facts(domain, state, weights)

    def alternatives(
        self, state: State, request: ServiceRequest, cost: Cost, safe: Safe, count: int
    ) -> tuple[PlanReport, ...]:
        """Return up to ``count`` of the next best plans without loops, the best first, the optimal one left out.

        A* finds them in the same graph and order as the planner's; the solver has not proved them.
        """
        search = self._search(state, request, cost, safe)
        return tuple(report_of(plan, search.utility) for plan in best_plans(search, state, count + 1)[1:])

    def _search(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> Search:
        """Return the graph to find a plan in, with the weights of this moment."""
        memory = self._recall(request, cost)
        memory.domain.check(state)
        utility = Utility(self.preset, cost, safe, memory.tree.floor)
        return Search(memory.tree.out_of, utility, memory.domain.last)

    def _recall(self, request: ServiceRequest, cost: Cost) -> _Memory:
        """Return what is kept of a request; the one place that decides whether the kept tree still holds."""
        memory = self._memory.pop(request, None)
        if memory is None:
            domain = Domain(self.network, request)
            memory = _Memory(domain, backward_tree(domain, self.preset, cost), cost)
        elif cost is not memory.cost or self.preset.cost_update == "current pose":
            if not memory.tree.bounds(cost):
                memory.tree = backward_tree(memory.domain, self.preset, cost)
            memory.cost = cost
        self._memory[request] = memory
        if len(self._memory) > REMEMBERED:
            del self._memory[next(iter(self._memory))]
        return memory


def report_of(plan: TaskPlan, utility: Utility, *, optimal: bool = False) -> PlanReport:
    terms, total, steps = utility.total(plan)
    return PlanReport(plan, *terms, total, optimal, steps=steps)
