"""A user's own rules for plans, in ASP: they forbid plans, demand something of them, or add to what they cost.

Allowed are constraints, weak constraints and ``#minimize``, and definitions of further predicates without recursion.
Nothing in them can run code, read a file, ground without end, or change what the planner's own program means.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from typing import NamedTuple

import clingo
from clingo import ast

from tmpud.errors import RulesError
from tmpud.roads.network import RoadNetwork
from tmpud.task.solver import CENTIMETRES

Log = Callable[[clingo.MessageCode, str], None]


class Predicate(NamedTuple):
    name: str
    arity: int

    def __str__(self) -> str:
        return f"{self.name}/{self.arity}"


def _predicates(text: str) -> frozenset[Predicate]:
    return frozenset(Predicate(name, int(arity)) for name, arity in (word.split("/") for word in text.split()))


OF_PLANS = _predicates("do/4 visit/2 onlane/1 onedge/1 start/2 last/1 goal/2 position/1 merge/1")
OF_THE_MAP = _predicates("can/6 weight/5 effect/3 serves/3 leftof/2 ahead/2 uncut/1 connected/3 lane/3")
_STRING, _LARGE = re.compile(r'"(?:\\.|[^"\\])*"'), re.compile(r"\d{10,}")  # the solver's integers wrap
_NAMED = {  # which arguments name what on the map
    Predicate("onlane", 1): {0: "lane"},
    Predicate("onedge", 1): {0: "edge"},
    Predicate("visit", 2): {0: "segment"},
    Predicate("do", 4): {0: "segment", 3: "segment"},
}


class Name(NamedTuple):
    """Something on the map that a rule speaks of."""

    line: int
    kind: str  # lane, edge or segment
    text: str


@dataclass(frozen=True, slots=True)
class Rules:
    """Rules that were checked."""

    text: str
    source: str
    local: bool  # they ask for nothing but plans, so that a part of the map can prove a plan
    names: tuple[Name, ...] = ()

    def check(self, network: RoadNetwork) -> None:
        """Raise RulesError where a rule names what the map does not have: it would silently never apply."""
        known = {"lane": network.lanes, "edge": network.edges, "segment": network.segments}
        for line, kind, text in self.names:
            if text not in known[kind]:
                close = difflib.get_close_matches(text, known[kind], n=3, cutoff=0.5) or list(known[kind])[:3]
                raise RulesError(self.source, line, f"{kind} {text!r} is not on {network.name}; there is {close}")


def read_rules(text: str, source: str) -> Rules:
    """Check rules and return them; RulesError with ``source`` and line where they are not allowed or not ASP."""
    for number, line in enumerate(text.split("\n"), 1):
        if "#include" in line or "\0" in line:
            raise RulesError(source, number, "#include and binary data are not allowed")
        if large := _LARGE.search(_STRING.sub("", line)):
            raise RulesError(source, number, f"{large[0]} is too large a number: at most {10**9 - 1}")
    checker, statements = _Checker(source), list[ast.AST]()
    _reporting(source, lambda log: ast.parse_string(text, statements.append, logger=log))
    for statement in statements:
        checker.statement(statement)
    checker.finish()
    _reporting(source, lambda log: _ground(text, log))
    return Rules(text, source, checker.local, tuple(checker.names))


class _Checker(ast.Transformer):
    """Takes in one statement after the other and refuses what is not allowed."""

    def __init__(self, source: str) -> None:
        self.source, self.line = source, 1
        self.names: list[Name] = []
        self._asked: dict[Predicate, int] = {}  # with the line where it is asked for first
        self._defined: dict[Predicate, set[Predicate]] = {}  # with what its definitions ask for
        self._body: set[Predicate] = set()

    def statement(self, statement: ast.AST) -> None:
        self.line, self._body = statement.location.begin.line, set()
        kind = statement.ast_type
        if kind in (ast.ASTType.Comment, ast.ASTType.Defined) or str(statement) == "#program base.":
            return
        if kind is ast.ASTType.Minimize:
            self._cost(statement)
        elif kind is not ast.ASTType.Rule:
            raise self._error(f"{kind.name} is not allowed: rules are constraints, costs and definitions")
        self.visit_sequence(statement.body)
        if kind is ast.ASTType.Rule:
            self._head(statement.head)

    def finish(self) -> None:
        """Check what only the whole of the rules shows."""
        known = OF_PLANS | OF_THE_MAP | self._defined.keys()
        for predicate, line in self._asked.items():
            if predicate not in known:
                self.line = line
                raise self._error(f"nothing defines {predicate}; there are {', '.join(sorted(map(str, OF_PLANS)))}")
        try:
            TopologicalSorter(self._defined).prepare()
        except CycleError as error:
            raise self._error(f"{error.args[1][0]} depends on itself, which is not allowed") from error

    @property
    def local(self) -> bool:
        """Whether the rules ask for nothing but plans."""
        return OF_THE_MAP.isdisjoint(self._asked)

    def visit_SymbolicAtom(self, atom: ast.AST) -> ast.AST:  # noqa: N802  a name that clingo looks for
        for symbol in _functions(atom.symbol):
            predicate = Predicate(symbol.name, len(symbol.arguments))
            self._asked.setdefault(predicate, self.line)
            self._body.add(predicate)
            for place, kind in _NAMED.get(predicate, {}).items():
                self._name(kind, symbol.arguments[place])
        self.visit_children(atom)
        return atom

    def visit_Function(self, term: ast.AST) -> ast.AST:  # noqa: N802
        if term.external:
            raise self._error(f"@{term.name} is not allowed: rules run no code")
        self.visit_children(term)
        return term

    def visit_Interval(self, term: ast.AST) -> ast.AST:  # noqa: N802
        raise self._error(f"{term} is not allowed: an interval can be endless")

    def visit_TheoryAtom(self, atom: ast.AST) -> ast.AST:  # noqa: N802
        raise self._error(f"{atom} is not allowed: there are no theories here")

    def _cost(self, statement: ast.AST) -> None:
        """Refuse what could make a plan cheaper, or matters more than what is driven."""
        if not 0 <= _number(statement.weight) < math.inf:
            raise self._error(f"cost {statement.weight} is not a number of centimetres from 0 up")
        if not _number(statement.priority) <= CENTIMETRES:
            raise self._error(f"priority {statement.priority} is not a number up to {CENTIMETRES}, the centimetres'")

    def _head(self, head: ast.AST) -> None:
        if head.ast_type is not ast.ASTType.Literal or head.sign:
            raise self._error(f"{head} is not allowed as a head: rules choose nothing")
        if head.atom.ast_type is ast.ASTType.BooleanConstant:
            return
        if head.atom.ast_type is not ast.ASTType.SymbolicAtom:
            raise self._error(f"{head} is not allowed as a head")
        for symbol in _functions(head.atom.symbol):
            predicate = Predicate(symbol.name, len(symbol.arguments))
            if predicate in OF_PLANS | OF_THE_MAP:
                raise self._error(f"{predicate} is the planner's own and cannot be defined")
            self._defined.setdefault(predicate, set()).update(self._body)
        self.visit_children(head.atom)

    def _name(self, kind: str, term: ast.AST) -> None:
        if term.ast_type is ast.ASTType.SymbolicTerm:
            if term.symbol.type is not clingo.SymbolType.String:
                raise self._error(f'{term} needs quotes, as the name of every {kind} does: "{term}"')
            self.names.append(Name(self.line, kind, term.symbol.string))

    def _error(self, cause: str) -> RulesError:
        return RulesError(self.source, self.line, cause)


def _functions(symbol: ast.AST) -> Iterable[ast.AST]:
    """Return what an atom may be: f(x) is one, f(x;y) are two; -f(x) counts as f(x)."""
    if symbol.ast_type is ast.ASTType.Pool:
        return [function for argument in symbol.arguments for function in _functions(argument)]
    return _functions(symbol.argument) if symbol.ast_type is ast.ASTType.UnaryOperation else [symbol]


def _number(term: ast.AST) -> float:
    if term.ast_type is ast.ASTType.SymbolicTerm and term.symbol.type is clingo.SymbolType.Number:
        return float(term.symbol.number)
    return math.inf


def _ground(text: str, log: Log) -> None:
    """Ground rules alone, for the errors that this shows."""
    control = clingo.Control(logger=log)
    control.add("base", [], text)
    control.ground([("base", [])])


def _reporting(source: str, work: Callable[[Log], None]) -> None:
    """Do something with clingo; its errors become one line with the user's file and line."""
    messages: list[str] = []
    try:
        work(lambda _, message: messages.append(message))
    except RuntimeError as error:
        text = "".join(message for message in messages if " error: " in message)
        place = re.search(r"<\w+>:(\d+):[^ ]* (?:note|error): (?!unsafe)(.*)", text)
        raise RulesError(source, int(place[1]) if place else None, place[2] if place else str(error)) from error
