"""Shortest paths by libraries: each keeps its own graph, whose weights can be changed, and knows nothing of before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from benchmarks.harness import Entry, need
from benchmarks.questions import Graph, Question


class Router(Protocol):
    """Shortest paths on a graph."""

    def weigh(self, edge: int, weight: int) -> None:
        """Change an edge's weight [cm]."""

    def shortest(self, start: int, goal: int) -> float:
        """Return the length of the shortest path [cm]."""


def entry(name: str, make: Callable[[Graph], Router], graph: Graph, tolerance: float = 0.0) -> Entry[Question]:
    """Return a router that has, as our planner has, answered the old question before time runs."""
    router = make(graph)
    changed: list[int] = []

    def pose(question: Question) -> Callable[[], float]:
        for edge in changed:
            router.weigh(edge, graph.weights[edge])
        router.shortest(question.start, question.goal)
        changed[:] = [question.edge]
        router.weigh(question.edge, question.weight)
        return lambda: router.shortest(question.start, question.goal)

    return Entry(name, pose, tolerance)


class Networkx:
    """Bidirectional Dijkstra in pure Python."""

    def __init__(self, graph: Graph) -> None:
        need("networkx")
        import networkx

        self._find, self._ends = networkx.bidirectional_dijkstra, list(graph.edges)
        self._graph = networkx.DiGraph()
        self._graph.add_weighted_edges_from((*ends, graph.weights[edge]) for ends, edge in graph.edges.items())

    def weigh(self, edge: int, weight: int) -> None:
        a, b = self._ends[edge]
        self._graph[a][b]["weight"] = weight

    def shortest(self, start: int, goal: int) -> float:
        return float(self._find(self._graph, start, goal)[0])


class Rustworkx:
    """Dijkstra in Rust, from point to point; edges hold their weights as floats."""

    def __init__(self, graph: Graph) -> None:
        need("rustworkx")
        import rustworkx

        self._find, self._ends = rustworkx.digraph_dijkstra_shortest_path_lengths, list(graph.edges)
        self._graph: Any = rustworkx.PyDiGraph()
        self._graph.add_nodes_from(range(len(graph.index)))
        self._graph.add_edges_from([(*ends, float(graph.weights[edge])) for ends, edge in graph.edges.items()])

    def weigh(self, edge: int, weight: int) -> None:
        self._graph.update_edge(*self._ends[edge], float(weight))

    def shortest(self, start: int, goal: int) -> float:
        return float(self._find(self._graph, start, float, goal=goal)[goal])


class Scipy:
    """Dijkstra in C++ (csgraph), which only knows one to all."""

    def __init__(self, graph: Graph) -> None:
        need("scipy")
        import numpy as np
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import dijkstra

        ends = np.array(list(graph.edges))
        size = len(graph.index)
        self._find = dijkstra
        self._graph: Any = csr_array((np.array(graph.weights, dtype=float), (ends[:, 0], ends[:, 1])), (size, size))

    def weigh(self, edge: int, weight: int) -> None:
        self._graph.data[edge] = weight  # edges are sorted as csr sorts them

    def shortest(self, start: int, goal: int) -> float:
        return float(self._find(self._graph, indices=start)[goal])
