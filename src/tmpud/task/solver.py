"""The only place that talks to clingo: one program, one thread, no wall-clock limit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter

import clingo

from tmpud.errors import NoPlanError
from tmpud.symbols import Transition
from tmpud.task.facts import encoding

# All optimal plans at once: the union of their atoms ("brave consequences").
OPTIONS = ("--warn=none", "--opt-mode=optN", "--enum-mode=brave")
CENTIMETRES = 3  # the priority of quality.lp


@dataclass(frozen=True, slots=True)
class Answer:
    """What the solver found."""

    union: tuple[Transition, ...]  # of all optimal plans; of one plan where the proof is missing
    centimetres: int  # the least total of the instance's weights
    optimal: bool  # proved
    ground_s: float  # [s] wall-clock
    solve_s: float  # [s] wall-clock


def ask(instance: str, transitions: Iterable[Transition], options: Sequence[str] = ()) -> Answer | None:
    """Return the best plans of an instance, None where it has none; raises NoPlanError where a limit came first."""
    began = perf_counter()
    control = clingo.Control([*OPTIONS, *options])
    control.add("base", [], encoding())
    control.add("base", [], instance)
    control.ground([("base", [])])
    grounded = perf_counter()
    found = _last_model(control)
    if found is None:
        return None
    named = {(t.state.segment, t.state.leg, t.action.value, t.next_state.segment): t for t in transitions}
    union = tuple(named[_key(atom)] for atom in found.atoms)
    return Answer(union, found.centimetres, found.proved, grounded - began, perf_counter() - grounded)


@dataclass(slots=True)
class _LastModel:
    """Keeps the last model, which is the union once optimality is proved; to iterate instead would start a thread."""

    atoms: Sequence[clingo.Symbol] = ()
    centimetres: int = 0
    proved: bool = False

    def __call__(self, model: clingo.Model) -> None:
        self.atoms, self.proved = model.symbols(shown=True), model.optimality_proven
        self.centimetres = dict(zip(model.priority, model.cost, strict=True)).get(CENTIMETRES, 0)


def _last_model(control: clingo.Control) -> _LastModel | None:
    found = _LastModel()
    result = control.solve(on_model=found)
    if result.unknown:
        raise NoPlanError("the solver gave up at its limit of conflicts, before it found a plan")
    return found if result.satisfiable else None


def _key(atom: clingo.Symbol) -> tuple[str, int, str, str]:
    origin, leg, action, target = atom.arguments
    return origin.string, leg.number, action.name, target.string
