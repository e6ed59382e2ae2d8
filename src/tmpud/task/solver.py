"""The only place that talks to clingo: one program, one thread, no wall-clock limit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import NamedTuple

import clingo

from tmpud.errors import NoPlanError, UtilityOverflowError
from tmpud.symbols import Transition
from tmpud.task.corridor import Stretch
from tmpud.task.utility import LIMIT

# All optimal plans at once: the union of their atoms ("brave consequences").
OPTIONS = ("--warn=none", "--opt-mode=optN", "--enum-mode=brave")
CENTIMETRES = 3  # the priority of quality.lp

Choice = Callable[[Sequence[Transition]], Transition | None]


@dataclass(frozen=True, slots=True)
class Answer:
    """What the solver found."""

    union: tuple[Transition, ...]  # of all optimal plans; of one plan where the proof is missing; empty: no plan
    centimetres: int  # the least total of the program's weights
    optimal: bool  # proved
    ground_s: float  # [s] wall-clock
    solve_s: float  # [s] wall-clock


class _Model(NamedTuple):
    atoms: Sequence[clingo.Symbol] = ()
    centimetres: int = 0
    optimal: bool = True

    @classmethod
    def of(cls, model: clingo.Model) -> _Model:
        total = dict(zip(model.priority, model.cost, strict=True)).get(CENTIMETRES, 0)
        return cls(model.symbols(shown=True), total, model.optimality_proven)


def ask(program: str, ways: Mapping[str, Stretch], options: Sequence[str] = ()) -> Answer:
    """Return the best plans of a program, made of ways by their names in it.

    Raises NoPlanError where a limit of the solver came first.
    """
    began = perf_counter()
    control = clingo.Control([*OPTIONS, *options])
    control.add("base", [], program)
    control.ground([("base", [])])
    grounded = perf_counter()
    model = _last(control)
    union = tuple(step for atom in model.atoms for step in ways[_name(atom)])
    return Answer(union, model.centimetres, model.optimal, grounded - began, perf_counter() - grounded)


def ask_one(program: str, ways: Mapping[str, Stretch], choose: Choice, options: Sequence[str] = ()) -> Answer:
    """Return one of the best plans of a program in which parts of different best plans may not fit together.

    Each way is one transition. ``choose`` takes one out of their union, again out of the union of those that have it,
    and so on, until it returns None. Raises NoPlanError, and UtilityOverflowError where the weights are too large to
    be added.
    """
    began = perf_counter()
    control = clingo.Control([*OPTIONS, *options])
    weights = _Weights()
    control.register_observer(weights)
    control.add("base", [], program)
    control.ground([("base", [])])
    grounded = perf_counter()
    model = _last(control)
    weights.check()
    union = {ways[_name(atom)][0]: atom for atom in model.atoms}
    chosen: list[tuple[clingo.Symbol, bool]] = []
    while model.optimal and (transition := choose(tuple(union))):
        chosen.append((union[transition], True))
        union = {ways[_name(atom)][0]: atom for atom in _last(control, chosen).atoms}
    return Answer(tuple(union), model.centimetres, model.optimal, grounded - began, perf_counter() - grounded)


class _Weights(clingo.Observer):
    """Adds up what the ground program minimises, since the solver itself would wrap."""

    def __init__(self) -> None:
        self._totals: Counter[int] = Counter()

    def minimize(self, priority: int, literals: Sequence[tuple[int, int]]) -> None:
        self._totals[priority] += sum(weight for _, weight in literals)

    def check(self) -> None:
        if any(total >= LIMIT for total in self._totals.values()):
            raise UtilityOverflowError("the rules add too much: all costs together must lie below 2^31")


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
