"""ASP as it is usually written for such planning, on the facts of the whole map that our planner itself would write."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import clingo

from benchmarks.harness import Entry
from benchmarks.questions import Graph, Question
from tmpud.task.asp_planner import AspPlanner

HERE = Path(__file__).parent
QUIET = "--warn=none"


def enumeration(name: str, graph: Graph, horizon: int) -> Entry[Question]:
    """Enumerate every plan of at most ``horizon`` actions and pick the cheapest outside."""
    encoding = (HERE / "step_indexed.lp").read_text(encoding="utf-8")

    def pose(question: Question) -> Callable[[], float]:
        facts, weights = _instance(graph, question), _weights(graph, question)

        def work() -> float:
            totals: list[int] = []

            def cost(model: clingo.Model) -> None:
                steps = (atom.arguments for atom in model.symbols(shown=True))
                totals.append(sum(weights[step[0].string, step[2].string] for step in steps))

            _ground(encoding, facts, horizon, "0").solve(on_model=cost)
            return min(totals)

        return work

    return Entry(name, pose)


def minimize(name: str, graph: Graph, horizon: int) -> Entry[Question]:
    """Let the solver find and prove the cheapest plan of at most ``horizon`` actions (branch and bound)."""
    encoding = "\n".join((HERE / file).read_text(encoding="utf-8") for file in ("step_indexed.lp", "cheapest.lp"))

    def pose(question: Question) -> Callable[[], float]:
        facts = _instance(graph, question)

        def work() -> float:
            totals: list[int] = []
            _ground(encoding, facts, horizon).solve(on_model=lambda model: totals.append(model.cost[0]))
            return totals[-1]

        return work

    return Entry(name, pose)


def one_fact(name: str) -> Entry[Question]:
    """Do what no planner that uses clingo can do without; it answers nothing."""

    def work() -> float:
        control = clingo.Control([QUIET])
        control.add("base", [], "fact.")
        control.ground([("base", [])])
        control.solve()
        return 0.0

    def pose(question: Question) -> Callable[[], float]:  # noqa: ARG001
        work()
        return work

    return Entry(name, pose, compared=False)


def _ground(encoding: str, facts: str, horizon: int, *options: str) -> clingo.Control:
    control = clingo.Control([QUIET, f"--const=n={horizon}", *options])
    control.add("base", [], encoding)
    control.add("base", [], facts)
    control.ground([("base", [])])
    return control


def _instance(graph: Graph, question: Question) -> str:
    planner = AspPlanner(graph.network, prune=False)
    return planner.instance(question.state, question.request, graph.cost, question.safe)


def _weights(graph: Graph, question: Question) -> dict[tuple[str, str], int]:
    names = list(graph.index)
    weights = [*graph.weights]
    weights[question.edge] = question.weight
    return {(names[a], names[b]): weights[edge] for (a, b), edge in graph.edges.items()}
