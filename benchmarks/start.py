"""Process start: what a command takes from nothing to its end, beside Python's own start.

    python -m benchmarks start --rounds 20

Files are in the system's cache after the warm-up; nothing else is kept between two processes. Two tables: the wall
clock's time, which other load makes longer, and the CPU's.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.harness import DisagreementError, Result, progress

PYTHON = "python, nothing else"
TMPUD = [str(Path(sys.executable).with_name("tmpud"))]
COMMANDS = {
    PYTHON: [sys.executable, "-c", "pass"],
    "import clingo": [sys.executable, "-c", "import clingo"],
    "import typer": [sys.executable, "-c", "import typer"],
    "tmpud --version": [*TMPUD, "--version"],
    "tmpud --help": [*TMPUD, "--help"],
    "tmpud plan": [*TMPUD, "plan", "--from", "random", "--to", "random", "--json"],
}


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rounds", type=int, default=20)


def measure(asked: argparse.Namespace) -> list[Result]:
    progress(f"start: {asked.rounds} rounds of {len(COMMANDS)} commands")
    for command in COMMANDS.values():
        spent(command)
    rows = [{name: spent(command) for name, command in COMMANDS.items()} for _ in range(asked.rounds)]
    clocks = enumerate(("wall clock", "CPU time"))
    return [
        Result("process start", PYTHON, {name: [row[name][i] for row in rows] for name in COMMANDS}, clock=clock)
        for i, clock in clocks
    ]


def spent(command: list[str]) -> tuple[float, float]:
    """Return the time that a process took by the wall clock and on the CPU [s]; it must end well."""
    began = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    elapsed = time.perf_counter() - began
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise DisagreementError(f"{' '.join(command)} ended with exit code {process.returncode}")
    return elapsed, usage.ru_utime + usage.ru_stime
