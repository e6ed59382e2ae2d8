"""Run the full figures and write them, dated, to ``docs/verification.json`` and ``docs/verification.md``.

    python -m tools.verify                  every section
    python -m tools.verify plans nets       some; the others' results are kept
    python -m tools.verify missions --missions 2 --output try    a short try elsewhere

The exit code is 1 where a target is missed, 130 where interrupted; sections that were done by then are written.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path

from tools.verification import agreement, carla, faults, missions, paper, runs
from tools.verification.figures import ROOT, Figure, keep, provenance, section
from tools.verification.options import Options

SECTIONS: dict[str, Callable[[Options], list[Figure]]] = {
    "plans": agreement.plans,
    "estimates": agreement.estimates,
    "turns": agreement.turns,
    "nets": agreement.nets,
    "damages": faults.damages,
    "hangs": faults.hangs,
    "supervisors": faults.supervisors,
    "interrupts": faults.interrupts,
    "disks": faults.disks,
    "kills": faults.kills,
    "traffic": runs.traffic,
    "repeat": runs.repeat,
    "carla-repeat": carla.repeat,
    "carla-left": carla.left,
    "carla-missions": carla.missions,
    "figure4": paper.figure4,
    "calibration": paper.calibration,
    "same-results": paper.same_results,
    "missions": missions.missions,
    "table1": paper.table1,
    "table1-presets": paper.table1_presets,
}  # the quick ones first
USED = {
    "plans": ("graphs",),
    "estimates": ("cases",),
    "turns": ("given_maps",),
    "nets": ("mutants", "given_maps"),
    "damages": ("damages",),
    "hangs": ("hangs",),
    "supervisors": ("meetings",),
    "interrupts": ("interrupts",),
    "disks": ("disks",),
    "kills": ("kills",),
    "traffic": ("seconds",),
    "repeat": ("repeats", "traffic"),
    "carla-repeat": ("repeats", "traffic"),
    "carla-left": ("kills",),
    "carla-missions": ("carla_missions",),
    "figure4": ("figure_trials",),
    "calibration": (),
    "same-results": ("same_trials",),
    "missions": ("missions", "traffic", "given_maps"),
    "table1": ("table_trials",),
    "table1-presets": ("table_trials",),
}  # the options that change a section


def main(arguments: Sequence[str] | None = None) -> int:
    parser = _parser()
    asked = parser.parse_args(arguments)
    names = asked.sections or list(SECTIONS)
    if unknown := [name for name in names if name not in SECTIONS]:
        parser.error(f"no section is called {unknown[0]}; there are {', '.join(SECTIONS)}")
    options = Options(
        given_maps=tuple(str(Path(file).resolve()) for file in asked.map),
        **{name: getattr(asked, name) for name in _counts()},
    )
    held = True
    try:
        for name in names:
            held &= _verify(name, options, asked.output)
    except KeyboardInterrupt:
        print("\ninterrupted; the sections done so far are written", file=sys.stderr)
        return 130
    return 0 if held else 1


def _verify(name: str, options: Options, output: Path) -> bool:
    """Run one section and write it; whether its targets are met."""
    begun, start = provenance(_command(name, options)), time.monotonic()
    figures = SECTIONS[name](options)
    keep(output, name, section(begun, figures, time.monotonic() - start))
    for figure in figures:
        print(f"{'holds ' if figure.holds else 'MISSED'}  {figure.what}: {figure.result} (n = {figure.n:,})")
    return all(figure.holds for figure in figures)


def _command(name: str, options: Options) -> str:
    """Return the command that repeats a section, maps named without their folders."""
    default = Options()
    changed = [n for n in USED[name] if n != "given_maps" and getattr(options, n) != getattr(default, n)]
    counts = [f"--{n} {getattr(options, n):g}" for n in changed]
    maps = [f"--map {Path(file).name}" for file in options.given_maps if "given_maps" in USED[name]]
    return " ".join(["python -m tools.verify", name, *counts, *maps])


def _counts() -> dict[str, float]:
    return {f.name: f.default for f in fields(Options) if isinstance(f.default, int | float)}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=f"of {', '.join(SECTIONS)}; default: all")
    parser.add_argument(
        "--map", action="append", default=[], help="a net file beside the shipped towns; repeat for more"
    )
    parser.add_argument("--output", type=Path, default=ROOT / "docs", help="the folder to write into")
    for name, default in _counts().items():
        parser.add_argument(f"--{name}", type=type(default), default=default, help=f"default: {default:,}")
    return parser


if __name__ == "__main__":
    sys.exit(main())
