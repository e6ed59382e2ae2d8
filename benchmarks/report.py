"""Results as an aligned table and as JSON, with the machine they were measured on."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from math import isfinite
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.harness import ENOUGH, Result

PACKAGES = ("tmpud", "clingo", "highway-env", "libsumo", "networkx", "numpy", "rustworkx", "scipy", "sumolib")
FEW = 5  # rounds up to which each is shown
CPUINFO = Path("/proc/cpuinfo")


def table(result: Result) -> str:
    """Return the medians, the slow end and the ratios to the base as aligned lines."""
    rounds = len(result.times[result.base])
    slow = "p99" if rounds >= ENOUGH else "slowest"
    head = [f"{result.title} (n = {rounds}, {result.clock})", "median", slow, f"x {result.base}"]
    if result.batch:
        head.append(f"{result.batch[1]}/s")
    if rounds <= FEW:
        head.append("each round")
    rows = [head, *([name, *_numbers(result, name)] for name in result.times)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    lines = [
        "  ".join(
            [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]
    return "\n".join([*lines, *(f"{name}: skipped, {why}" for name, why in result.skipped.items())])


def _numbers(result: Result, name: str) -> list[str]:
    ratios, throughput = result.ratios(name), result.throughput(name)
    row = [shown(result.median(name)), shown(result.slow(name)), f"{median(ratios):.3g}"]
    if throughput is not None:
        row.append(f"{throughput:,.0f}")
    return [*row, " ".join(f"{ratio:.3g}" for ratio in ratios)] if len(ratios) <= FEW else row


def shown(seconds: float) -> str:
    """Return a time in the unit that suits it."""
    for unit, factor in (("us", 1e6), ("ms", 1e3)):
        if seconds * factor < 1000:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s"


def as_json(name: str, options: dict[str, Any], results: Sequence[Result]) -> dict[str, Any]:
    """Return all that a benchmark found, every round's time included."""
    return {
        "benchmark": name,
        "options": {key: _plain(value) for key, value in options.items()},
        "machine": machine(),
        "versions": dict(_versions()),
        "results": [_result(result) for result in results],
    }


def _plain(value: object) -> object:
    """Return a value that JSON has, or its text."""
    is_plain = isinstance(value, str | int | list) or (isinstance(value, float) and isfinite(value))
    return value if is_plain else str(value)


def _result(result: Result) -> dict[str, Any]:
    rows = {
        name: {
            "median_s": result.median(name),
            "slow_s": result.slow(name),
            "ratio": median(result.ratios(name)),
            "each_s": list(times),
            **({f"{result.batch[1]}_per_s": result.throughput(name)} if result.batch else {}),
        }
        for name, times in result.times.items()
    }
    facts = {"title": result.title, "base": result.base, "clock": result.clock, **result.facts}
    return {**facts, "n": len(result.times[result.base]), "entries": rows, "skipped": dict(result.skipped)}


def machine() -> dict[str, Any]:
    """Return what times depend on besides the code."""
    lines = CPUINFO.read_text().splitlines() if CPUINFO.exists() else []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return {
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "cores": os.cpu_count(),
        "cpu": models[0] if models else platform.processor(),
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "load": os.getloadavg()[0],
    }


def _versions() -> Iterator[tuple[str, str]]:
    for package in PACKAGES:
        try:
            yield package, version(package)
        except PackageNotFoundError:
            continue


def headline() -> str:
    """Return one line about the machine and the versions."""
    here = machine()
    packages = ", ".join(f"{name} {number}" for name, number in _versions())
    return f"{here['cores']} cores, {here['cpu']}, Python {here['python']}, load {here['load']:.1f}; {packages}"


def write(file: Path, found: Sequence[dict[str, Any]]) -> None:
    file.write_text(json.dumps(found if len(found) > 1 else found[0], indent=1) + "\n", encoding="utf-8")
