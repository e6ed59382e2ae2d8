"""Loading a map again: our reader, whose cache of large maps is empty at first, and sumolib.

    python -m benchmarks load --maps millbrook grid:20:2 --rounds 5

All must find as many lanes that cars may use, and as many ways from one of them to another. Of a map from the cache
that is known before its lanes have courses; "with all courses" has them worked out as well.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.harness import Entry, Result, field_of, need, progress, race
from benchmarks.nets import net_file
from benchmarks.report import shown
from tmpud.roads import RoadNetwork, load_map

OURS = "load_map (ours)"
Sizes = tuple[int, int]
CACHE = "XDG_CACHE_HOME"  # where load_map keeps large maps


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--maps", nargs="+", default=["millbrook", "grid:20:2"])
    parser.add_argument("--rounds", type=int, default=5)


def measure(asked: argparse.Namespace) -> list[Result]:
    results = []
    for name in asked.maps:
        with net_file(name) as file, empty_cache():
            entries, skipped = field_of({OURS: ours, "with all courses (ours)": with_courses, "sumolib": sumolib})
            progress(f"load: {name}, {asked.rounds} rounds")
            first = race(entries[:1], [file], warmup=0)
            times = race(entries, [file] * asked.rounds, warmup=0)
            facts = {"map": name, "lanes": len(load_map(file).lanes), "first_s": first[OURS][0]}
            title = f"{name}, {facts['lanes']} lanes; {shown(first[OURS][0])} the first time, then"
            results.append(Result(title, OURS, times, skipped, facts=facts))
    return results


@contextmanager
def empty_cache() -> Iterator[None]:
    """Let large maps be kept in a folder of this run's own."""
    before = os.environ.get(CACHE)
    with TemporaryDirectory() as folder:
        os.environ[CACHE] = folder
        try:
            yield
        finally:
            del os.environ[CACHE]
            if before is not None:
                os.environ[CACHE] = before


def ours() -> Entry[Path]:
    return Entry(OURS, lambda file: lambda: _counted(load_map(file)))


def with_courses() -> Entry[Path]:
    def count(file: Path) -> Sizes:
        network = load_map(file)
        _ = [*network.lanes.values()], [*network.connections]
        return _counted(network)

    return Entry("with all courses (ours)", lambda file: lambda: count(file))


def _counted(network: RoadNetwork) -> Sizes:
    """Return how many lanes there are, and how many ways lead out of them."""
    return len(network.lanes), sum(len(network.leads_to(lane)) for lane in network.lanes)


def sumolib() -> Entry[Path]:
    """Return SUMO's own reader in Python, with the ways through junctions, which we read as well."""
    need("sumolib")
    from sumolib.net import readNet

    def count(file: Path) -> Sizes:
        edges = readNet(str(file), withInternal=True).getEdges(withInternal=False)
        lanes = [lane for edge in edges for lane in edge.getLanes() if lane.allows("passenger")]
        ways = (way for lane in lanes for way in lane.getOutgoing())
        return len(lanes), sum(way.getToLane().allows("passenger") for way in ways)

    return Entry("sumolib", lambda file: lambda: count(file))
