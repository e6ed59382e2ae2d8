"""The only place that talks to clingo: one program, one thread, no wall-clock limit."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from time import perf_counter
from typing import NamedTuple

import clingo

from tmpud.errors import NoPlanError, UtilityOverflowError
from tmpud.symbols import State, Transition
from tmpud.task.corridor import Corridor, Stretch
from tmpud.task.utility import LIMIT

# All optimal plans at once: the union of their atoms ("brave consequences").
OPTIONS = ("--warn=none", "--opt-mode=optN", "--enum-mode=brave")
CENTIMETRES, MERGES, ACTIONS = 3, 2, 1  # the priorities of quality.lp

Choice = Callable[[Sequence[Transition]], Transition | None]


@dataclass(frozen=True, slots=True)
class Question:
    """A ground program, and the ways that its atoms do(...) stand for by what is in their brackets."""

    control: clingo.Control
    ways: Mapping[str, Stretch]
    ground_s: float  # [s] wall-clock


@dataclass(frozen=True, slots=True)
class Answer:
    """What the solver found."""

    union: tuple[Transition, ...]  # of all optimal plans; of one plan where the proof is missing; empty: no plan
    centimetres: int  # the least total of the program's weights
    optimal: bool  # proved
    solve_s: float  # [s] wall-clock


def written(program: str, ways: Mapping[str, Stretch], options: Sequence[str] = ()) -> Question:
    """Return the question that a program asks; raises UtilityOverflowError for weights too large to be added."""
    began = perf_counter()
    control = clingo.Control([*OPTIONS, *options])
    weights = _Weights()
    control.register_observer(weights)
    control.add("base", [], program)
    control.ground([("base", [])])
    weights.check()
    return Question(control, ways, perf_counter() - began)


def ground(start: State, last: int, given: Corridor, options: Sequence[str] = ()) -> Question:
    """Return the question which of a corridor's plans are the best.

    It is what clingo's grounder makes of ``plan.lp`` and ``reduced.lp`` for the corridor's stretches, given to the
    solver directly: four fifths of a small plan's time were spent on reading and grounding those few lines.
    """
    began = perf_counter()
    control = clingo.Control([*OPTIONS, *options])
    ways = given.stretches(start)
    with control.backend() as program:
        do = [program.add_atom(_do(n)) for n in range(len(ways))]
        visit: defaultdict[State, int] = defaultdict(program.add_atom)
        program.add_rule([visit[start]])
        choices: defaultdict[State, list[int]] = defaultdict(list)
        for atom, way in zip(do, ways, strict=True):
            choices[way[0].state].append(atom)
            program.add_rule([visit[way[-1].next_state]], [atom])
        for state, atoms in choices.items():
            program.add_rule(atoms, [visit[state]], choice=True)
            program.add_rule([], [visit[state], *(-atom for atom in atoms)])
            for two in combinations(atoms, 2):
                program.add_rule([], two)
        program.add_rule([], [-visit[state] for state in list(visit) if state.leg == last])
        more = zip(*map(given.reduced, ways), strict=True)
        for priority, amounts in zip((CENTIMETRES, MERGES, ACTIONS), more, strict=True):
            program.add_minimize(priority, list(zip(do, amounts, strict=True)))
    return Question(control, {str(n): way for n, way in enumerate(ways)}, perf_counter() - began)


def ask(question: Question, choose: Choice | None = None) -> Answer:
    """Return the best plans; raises NoPlanError where a limit of the solver came first.

    With user's rules parts of different best plans may not fit together. Then ``choose`` takes one transition out of
    their union, again out of the union of those that have it, and so on, until it returns None; each way must be
    one transition.
    """
    began = perf_counter()
    model = _last(question.control)
    union = {question.ways[_name(atom)]: atom for atom in model.atoms}
    chosen: list[tuple[clingo.Symbol, bool]] = []
    while choose and model.optimal and (step := choose([way[0] for way in union])):
        chosen.append((union[(step,)], True))
        union = {question.ways[_name(atom)]: atom for atom in _last(question.control, chosen).atoms}
    steps = tuple(step for way in union for step in way)
    return Answer(steps, model.centimetres, model.optimal, perf_counter() - began)


class _Model(NamedTuple):
    atoms: Sequence[clingo.Symbol] = ()
    centimetres: int = 0
    optimal: bool = True

    @classmethod
    def of(cls, model: clingo.Model) -> _Model:
        total = dict(zip(model.priority, model.cost, strict=True)).get(CENTIMETRES, 0)
        return cls(model.symbols(shown=True), total, model.optimality_proven)


class _Weights(clingo.Observer):
    """Adds up what the ground program minimises, since the solver itself would wrap."""

    def __init__(self) -> None:
        self._totals: Counter[int] = Counter()

    def minimize(self, priority: int, literals: Sequence[tuple[int, int]]) -> None:
        self._totals[priority] += sum(weight for _, weight in literals)

    def check(self) -> None:
        if any(total >= LIMIT for total in self._totals.values()):
            raise UtilityOverflowError("the rules add too much: all costs together must lie below 2^31")


@cache
def _do(way: int) -> clingo.Symbol:
    return clingo.Function("do", [clingo.Number(way)])


def _name(atom: clingo.Symbol) -> str:
    """Return a way's name out of the atom do(...)."""
    return str(atom)[3:-1]


def _last(control: clingo.Control, assumptions: Sequence[tuple[clingo.Symbol, bool]] = ()) -> _Model:
    """Return the last model, which is the union of the optimal ones where that is proved; empty if there is none."""
    models: list[_Model] = []
    result = control.solve(assumptions, on_last=lambda model: models.append(_Model.of(model)))
    if result.unknown:
        raise NoPlanError("the solver gave up at its limit of conflicts, before it found a plan")
    return models[0] if models else _Model()
