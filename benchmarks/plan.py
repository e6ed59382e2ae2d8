"""Task planning: our planner and others on the same maps, requests and weights.

    python -m benchmarks plan --maps millbrook grid:10:2 grid:20:1 --pairs 100

Each case is a random pair of segments. The first plan is made, its first action's Safe falls to 0.5, and everybody
answers the new question. Our replan and the libraries have answered the old one just before, as in a drive, and the
libraries have the graph at hand with its new weight; our first plan starts from the map and every Cost, ASP by steps
from the facts of the whole map. All must find the same least total of centimetres.

Maps are towns, net files, or ``grid:K:L`` (netgenerate: K x K crossings, L lanes each way; ``grid:K:L:even``
with blocks all alike). Each lane is one segment
unless ``--segment-length`` says otherwise. ASP by steps takes part on small maps only; there, pairs are such as a
plan of at most ``--horizon`` actions serves. Our first plan, which takes seconds on a city, is left to the benchmark
``city`` there; ``--goals 2`` has the path lengths to a goal worked out only twice.
"""

from __future__ import annotations

import argparse
import math
import random
from collections.abc import Callable
from contextlib import closing
from functools import partial
from itertools import islice
from pathlib import Path

from benchmarks.harness import Entry, Result, field_of, progress, race
from benchmarks.nets import net_file
from benchmarks.peers import asp, routers, sumo_router
from benchmarks.peers.compiled import Compiled
from benchmarks.questions import Graph, Question, draw, graph_of
from tmpud.roads import load_map
from tmpud.symbols import OptimisticSafe
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.search_planner import SearchPlanner

MAPS = ("millbrook", "grid:10:2", "grid:20:1")
REPLAN, FIRST, FLOOR = "ASP replan (ours)", "ASP first plan (ours)", "clingo on one fact"
SEARCH = "A* replan (ours, no proof)"
LIBRARIES: dict[str, Callable[[Graph], routers.Router]] = {
    "networkx, both ways": routers.Networkx,
    "rustworkx": routers.Rustworkx,
    "scipy, one to all": routers.Scipy,
    "C++ Dijkstra": Compiled,
}
SMALL = 300  # segments; beyond, planning by steps takes seconds
LARGE = 50_000  # segments; beyond, a first plan takes seconds
Makers = dict[str, Callable[[], Entry[Question]]]


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--maps", nargs="+", default=list(MAPS))
    parser.add_argument("--pairs", type=int, default=100)
    parser.add_argument("--goals", type=int, help="so many goals for all pairs (else one for each)")
    parser.add_argument("--horizon", type=int, default=10, help="of the encodings by steps")
    parser.add_argument("--segment-length", type=float, default=math.inf, help="longest segment [m]")
    parser.add_argument("--seed", type=int, default=1)


def measure(asked: argparse.Namespace) -> list[Result]:
    results = []
    for name in asked.maps:
        with net_file(name) as file, closing(sumo_router):
            graph = graph_of(load_map(file, asked.segment_length))
            results.append(on_map(name, graph, file, asked))
    return results


def on_map(name: str, graph: Graph, file: Path, asked: argparse.Namespace) -> Result:
    """Race on one map."""
    small = len(graph.index) <= SMALL
    entries, skipped = field_of(_planners(graph, file, asked.horizon if small else None))
    rng = random.Random(asked.seed)  # noqa: S311
    questions = list(islice(draw(graph, rng, asked.horizon if small else None, asked.goals), asked.pairs))
    size = f"{len(graph.network.lanes)} lanes, {len(graph.index)} segments"
    progress(f"{name}: {size}, {len(questions)} pairs, {len(entries)} planners")
    times = race(entries, questions)
    facts = {
        "map": name,
        "lanes": len(graph.network.lanes),
        "segments": len(graph.index),
        "transitions": len(graph.edges),
        "actions": [question.actions for question in questions],
    }
    return Result(f"{name}, {size}", REPLAN, times, skipped, facts=facts)


def _planners(graph: Graph, file: Path, horizon: int | None) -> Makers:
    """Return the planners for a map, those by steps where there is a horizon."""
    makers: Makers = {
        REPLAN: partial(replan, REPLAN, graph, AspPlanner),
        SEARCH: partial(replan, SEARCH, graph, SearchPlanner),
    }
    if len(graph.index) <= LARGE:
        makers[FIRST] = partial(first_plan, FIRST, graph)
    if horizon:
        for label, kind in (("enumeration by steps", asp.enumeration), ("#minimize by steps", asp.minimize)):
            makers[label] = partial(kind, label, graph, horizon)
    for label, library in LIBRARIES.items():
        makers[label] = partial(routers.entry, label, library, graph)
    sumo = partial(sumo_router.SumoRouter, file=file)
    makers["SUMO"] = partial(routers.entry, "SUMO", sumo, graph, sumo_router.TOLERANCE)
    return {**makers, FLOOR: partial(asp.one_fact, FLOOR)}


def replan(name: str, graph: Graph, kind: type[AspPlanner]) -> Entry[Question]:
    """Return a planner of ours, which has already planned for the request when its Safe falls."""
    planner = kind(graph.network)

    def pose(question: Question) -> Callable[[], float]:
        planner.solve(question.state, question.request, graph.cost, OptimisticSafe())
        return lambda: planner.solve(question.state, question.request, graph.cost, question.safe).total_cm

    return Entry(name, pose)


def first_plan(name: str, graph: Graph) -> Entry[Question]:
    """Return our planner when it sees the request for the first time; the map and every Cost are known."""

    def pose(question: Question) -> Callable[[], float]:
        planner = AspPlanner(graph.network)
        return lambda: planner.solve(question.state, question.request, graph.cost, question.safe).total_cm

    return Entry(name, pose)
