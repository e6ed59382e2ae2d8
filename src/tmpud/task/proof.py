"""How a plan is proved: on a corridor, which is widened where a user's rules leave no plan as good as its width.

A corridor holds every plan of the map up to some centimetres. Rules only forbid plans or add to their cost: the best
plan in a corridor, where it costs no more than that with the rules, is therefore the best on the map. That there is
none at all is final only on the whole map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from tmpud.symbols import State, Transition
from tmpud.task.corridor import Corridor, Search, corridor, whole_map
from tmpud.task.domain import Domain
from tmpud.task.facts import PLACES, REDUCED, choices, encoding, facts, places, spelled
from tmpud.task.solver import Choice, Question, ask, ground, written
from tmpud.task.ties import preferred
from tmpud.task.utility import check_total, most, split

if TYPE_CHECKING:
    from tmpud.task.rules import Rules

WIDER = (1.25, 2.0)  # times the optimum without rules, while the rules allow no plan; after these the whole map
NARROW = 100_00  # [cm] added to it


@dataclass(frozen=True, slots=True)
class Proof:
    """The best plans, and what it took to find them."""

    union: tuple[Transition, ...]  # of all best plans; with rules, of the preferred one; empty: there is none
    centimetres: int  # the least total, rules included
    optimal: bool
    transitions: int  # of the corridor, or map, of the last round
    rounds: int = 1
    ground_s: float = 0.0  # [s] wall-clock, of all rounds
    solve_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Prover:
    """How the solver is asked for the best plans."""

    prune: bool = True
    rules: Rules | None = None
    options: Sequence[str] = ()  # of the solver

    def prove(self, domain: Domain, search: Search, state: State) -> Proof | None:
        """Return the best plans from a state, None where no way leads to the goal; raises NoPlanError at a limit."""
        if not self.prune or (self.rules and not self.rules.local):
            return self._on_the_map(domain, search, state)
        best = corridor(search, state)
        if best is None:
            return None
        if self.rules is None:
            return self._in_corridor(domain, state, best)
        return self._widening(domain, search, state, split(best.optimum)[0])

    def _widening(self, domain: Domain, search: Search, state: State, optimum: int) -> Proof:
        """Return the best plan that the rules allow, at last from a corridor of all plans up to its own total."""
        wider = [round((optimum + NARROW) * factor) for factor in WIDER]
        limit: int | None = optimum  # [cm]
        rounds: list[Proof] = []
        while limit is not None and (given := corridor(search, state, most(limit))):
            proof = self._in_corridor(domain, state, given)
            rounds.append(proof)
            if proof.union and (proof.centimetres <= limit or not proof.optimal):
                return _summed(rounds)
            limit = proof.centimetres if proof.union else wider.pop(0) if wider else None
        return _summed([*rounds, self._on_the_map(domain, search, state)])

    def _in_corridor(self, domain: Domain, state: State, given: Corridor) -> Proof:
        """Return the best plans in a corridor, of which a user's rules may mention every transition."""
        check_total(given.ranks)
        if self.rules is None:
            return _proof(given, ground(state, domain.last, given, self.options))
        program = encoding(REDUCED) + choices(domain, state, given.ranks, given.reduced)
        return self._written(program, domain, state, given)

    def _on_the_map(self, domain: Domain, search: Search, state: State) -> Proof:
        given = whole_map(domain, search.utility, state)
        check_total(given.ranks)
        weights = {step: split(rank)[0] for step, rank in given.ranks.items()}
        return self._written(encoding() + facts(domain, state, weights), domain, state, given)

    def _written(self, program: str, domain: Domain, state: State, given: Corridor) -> Proof:
        ways = {spelled(step): (step,) for step in given.ranks}
        if self.rules is None:
            return _proof(given, written(program, ways, self.options))
        program += encoding(PLACES) + places(domain, state, given.ranks) + self.rules.text
        return _proof(given, written(program, ways, self.options), partial(preferred, state))


def _proof(given: Corridor, question: Question, choose: Choice | None = None) -> Proof:
    answer = ask(question, choose)
    total = answer.centimetres + split(given.optimum)[0]
    return Proof(answer.union, total, answer.optimal, len(given.ranks), 1, question.ground_s, answer.solve_s)


def _summed(rounds: Sequence[Proof]) -> Proof:
    """Return the last proof, with the times of all."""
    ground_s, solve_s = sum(proof.ground_s for proof in rounds), sum(proof.solve_s for proof in rounds)
    return replace(rounds[-1], rounds=len(rounds), ground_s=ground_s, solve_s=solve_s)
