"""``python -m benchmarks NAME [options]``: everybody takes turns, answers are compared, then times are printed."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from benchmarks import abstract, carla, frames, full_step, growth, highway, load, plan, safety, start, trials, view
from benchmarks.harness import DisagreementError, SkipError
from benchmarks.report import as_json, headline, table, write

BENCHMARKS: dict[str, ModuleType] = {
    "plan": plan,
    "load": load,
    "safety": safety,
    "start": start,
    "full_step": full_step,
    "highway": highway,
    "trials": trials,
    "abstract": abstract,
    "carla": carla,
    "view": view,
    "frames": frames,
}


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--json", type=Path, metavar="FILE", help="write every time that was measured, too")
    commands = parser.add_subparsers(dest="name", required=True, metavar="NAME")
    parsers = {"all": commands.add_parser("all", parents=[common], help="every benchmark but growth, as it is")}
    for name, module in {**BENCHMARKS, "growth": growth}.items():
        about = str(module.__doc__)
        parsers[name] = commands.add_parser(
            name,
            parents=[common],
            help=about.splitlines()[0],
            description=about,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.options(parsers[name])
    asked = parser.parse_args(arguments)
    jobs = {name: parsers[name].parse_args([]) for name in BENCHMARKS} if asked.name == "all" else {asked.name: asked}
    return _run(jobs, asked.json)


def _run(jobs: dict[str, argparse.Namespace], file: Path | None) -> int:
    print(headline(), flush=True)
    found: list[dict[str, Any]] = []
    for name, asked in jobs.items():
        try:
            results = {**BENCHMARKS, "growth": growth}[name].measure(asked)
        except DisagreementError as error:
            print(f"benchmarks: {name}: {error}", file=sys.stderr)
            return 1
        except SkipError as reason:
            print(f"\n{name}: skipped, {reason}")
            continue
        for result in results:
            print(f"\n{table(result)}", flush=True)
        found.append(as_json(name, vars(asked), results))
    if file:
        write(file, found)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
