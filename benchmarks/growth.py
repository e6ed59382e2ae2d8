"""How cost grows: with the map, the way's length, the vehicles and the samples; drawn as four plots.

    python -m benchmarks growth --out docs/images

Writes ``growth.svg``; the tables beside it are those of ``plan`` and ``safety``.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks import plan, safety
from benchmarks.harness import Result
from tmpud.presets import TMPUD

GRIDS = ("grid:4:2", "grid:8:2", "grid:16:2", "grid:32:2")
SIZES = (1, 2, 5, 10, 20, 50, 100, 200, 500)
SAMPLES = (100, 300, 1000, 3000, 10000)
LOOK: dict[Any, Any] = {"svg.hashsalt": "tmpud", "svg.fonttype": "none", "font.size": 8, "legend.fontsize": 6}
BAND = 5  # actions that are drawn as one point
Line = list[tuple[float, float]]  # points (size, median time [s])


def options(parser: argparse.ArgumentParser) -> None:
    plan.options(parser)
    parser.set_defaults(maps=list(GRIDS), pairs=50)
    parser.add_argument("--out", type=Path, default=Path("docs/images"), help="the folder for the picture")
    parser.add_argument("--sizes", type=int, nargs="+", default=list(SIZES), help="numbers of vehicles")
    parser.add_argument("--samples", type=int, nargs="+", default=list(SAMPLES), help="values of M")
    parser.add_argument("--rounds", type=int, default=20, help="scenes for each number of vehicles")


def measure(asked: argparse.Namespace) -> list[Result]:
    """Measure and draw."""
    maps = plan.measure(asked)
    few = argparse.Namespace(instants=10, rounds=asked.rounds, turn=0.005, seed=asked.seed)
    preset = replace(TMPUD, gate=-math.inf)
    crowds = [safety.among(count, preset, few, slow=False) for count in asked.sizes]
    samples = [safety.among(50, replace(preset, samples=count), few, slow=False) for count in asked.samples]
    panels = {
        "lanes of the map": lines(maps, "lanes"),
        f"actions of the plan, {maps[-1].facts['lanes']} lanes": by_actions(maps[-1]),
        "vehicles, 10 instants": lines(crowds, "vehicles"),
        "samples M, 50 vehicles, 10 instants": lines(samples, "samples"),
    }
    draw(panels, asked.out / "growth.svg")
    return [*maps, *crowds, *samples]


def lines(results: Sequence[Result], size: str) -> dict[str, Line]:
    """Return each entry's median against a size that the results differ in."""
    found: dict[str, Line] = {}
    for result in results:
        at: Any = result.facts[size]
        for name in result.times:
            found.setdefault(name, []).append((at, result.median(name)))
    return found


def by_actions(result: Result) -> dict[str, Line]:
    """Return each entry's median against the plan's number of actions, in bands."""
    actions: Any = result.facts["actions"]
    found: dict[str, Line] = {}
    for name, times in result.times.items():
        rows = sorted(zip(actions, times, strict=True))
        bands = [list(band) for _, band in groupby(rows, key=lambda row: row[0] // BAND)]
        found[name] = [(median(row[0] for row in band), median(row[1] for row in band)) for band in bands]
    return found


def draw(panels: Mapping[str, Mapping[str, Line]], file: Path) -> None:
    """Draw median CPU times on logarithmic axes, what is ours in bold; a name has one colour everywhere."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    file.parent.mkdir(parents=True, exist_ok=True)
    names = dict.fromkeys(name for drawn in panels.values() for name in drawn)
    colours = dict(zip(names, mpl.colormaps["tab20"].colors, strict=False))  # type: ignore[attr-defined]
    with mpl.rc_context(LOOK):
        figure = Figure(figsize=(10, 10), layout="constrained")
        for axes, (label, drawn) in zip(figure.subplots(2, 2).flat, panels.items(), strict=True):
            for name, line in drawn.items():
                width = 2.5 if "ours" in name else 1.0
                axes.semilogy(*zip(*line, strict=True), marker=".", linewidth=width, color=colours[name], label=name)
            axes.set_xscale("linear" if label.startswith("actions") else "log")
            axes.xaxis.set_major_formatter("{x:,.0f}")
            axes.set_xlabel(label)
            axes.set_ylabel("median CPU time [s]")
            axes.grid(alpha=0.3)
            axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3)
        figure.savefig(file, metadata={"Date": None})
