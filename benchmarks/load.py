"""Loading a map: our reader for the first and the second time, and sumolib.

    python -m benchmarks load --maps millbrook grid:20:2 --rounds 5

All must find the same number of lanes that cars may use. The cache of large maps is empty at first.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.harness import Entry, Result, field_of, need, progress, race
from benchmarks.nets import net_file
from benchmarks.report import shown
from tmpud.roads import load_map

OURS = "load_map (ours)"
CACHE = "XDG_CACHE_HOME"  # where load_map keeps large maps


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--maps", nargs="+", default=["millbrook", "grid:20:2"])
    parser.add_argument("--rounds", type=int, default=5)


def measure(asked: argparse.Namespace) -> list[Result]:
    results = []
    for name in asked.maps:
        with net_file(name) as file, empty_cache():
            entries, skipped = field_of({OURS: ours, "sumolib": sumolib})
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
    return Entry(OURS, lambda file: lambda: len(load_map(file).lanes))


def sumolib() -> Entry[Path]:
    """Return SUMO's own reader in Python, with the ways through junctions, which we read as well."""
    need("sumolib")
    from sumolib.net import readNet

    def count(file: Path) -> Callable[[], int]:
        read = partial(readNet, str(file), withInternal=True)
        return lambda: sum(
            lane.allows("passenger") for edge in read().getEdges(withInternal=False) for lane in edge.getLanes()
        )

    return Entry("sumolib", count)
