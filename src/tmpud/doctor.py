"""What is needed to drive, and whether it is there: each finding has a remedy of one line.

Whatever may abort, hang or print is tried in a process of its own.
"""

from __future__ import annotations

import importlib.metadata
import os
import platform
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

PYTHON = (3, 11)
PYARROW = "23.0."  # what libsumo was built with; with another it says so on every import
REACHED = 2.0  # [s] in which a server has to answer
STARTED = 30.0  # [s] in which a program has to do its part

CLINGO = """
import clingo
control = clingo.Control()
control.add("base", [], "{a; b}. :- a, b. #maximize {1: a; 1: b}.")
control.ground([("base", [])])
assert control.solve().satisfiable
print(clingo.__version__)
"""
SUMO = """
from tmpud.roads import load_map
from tmpud.simulators.sumo import SumoSimulator
with SumoSimulator(load_map("millbrook"), traffic=1, seed=1, warm_up=1.0) as town:
    assert len(town.everyone()) == 1
"""
SERVER = """
import sys
import carla
client = carla.Client(sys.argv[1], int(sys.argv[2]))
client.set_timeout(float(sys.argv[3]))
print(client.get_server_version())
"""


class State(StrEnum):
    OK = "ok"
    NOTE = "note"  # works, and could be better
    BAD = "bad"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at."""

    what: str
    state: State
    found: str
    remedy: str = ""


def examine(sim: str = "sumo", host: str = "127.0.0.1", port: int = 2000) -> Iterator[Finding]:
    """Yield what is found, in the order in which one thing needs the other; ``sim`` is sumo or carla."""
    yield _python()
    yield _clingo()
    yield _sumo_home()
    yield _pyarrow()
    yield _sumo()
    if sim == "carla":
        yield from _carla(host, port)


def _python() -> Finding:
    version = platform.python_version()
    if sys.version_info >= PYTHON:
        return Finding("Python", State.OK, version)
    return Finding("Python", State.BAD, version, f"install Python {PYTHON[0]}.{PYTHON[1]} or newer")


def _clingo() -> Finding:
    done, said = _tried(CLINGO)
    return Finding("clingo", State.OK, said) if done else Finding("clingo", State.BAD, said, "pip install clingo")


def _sumo_home() -> Finding:
    home = os.environ.get("SUMO_HOME")
    if home == "":
        return Finding("SUMO_HOME", State.NOTE, "set, but empty: SUMO's tools fail", "unset SUMO_HOME")
    return Finding("SUMO_HOME", State.OK, home or "not set, and not needed")


def _pyarrow() -> Finding:
    version = _version("pyarrow")
    if version is None or version.startswith(PYARROW):
        return Finding("pyarrow", State.OK, version or "not installed, and not needed")
    return Finding(
        "pyarrow", State.NOTE, f"{version}: libsumo complains on stderr", f"pip install 'pyarrow=={PYARROW}*'"
    )


def _sumo() -> Finding:
    version = _version("libsumo")
    if version is None:
        return Finding("SUMO", State.BAD, "libsumo is not installed", "pip install libsumo")
    done, said = _tried(SUMO)
    if done:
        return Finding("SUMO", State.OK, f"libsumo {version} drives millbrook")
    return Finding("SUMO", State.BAD, f"libsumo {version}: {said}", "pip install --force-reinstall libsumo")


def _carla(host: str, port: int) -> Iterator[Finding]:
    version = _version("carla")
    if version is None:
        yield Finding("CARLA's client", State.BAD, "not installed", "pip install 'tmpud[carla]'")
        return
    yield Finding("CARLA's client", State.OK, version)
    yield _server(host, port, version)


def _server(host: str, port: int, client: str) -> Finding:
    what, at = "CARLA's server", f"{host}:{port}"
    try:
        socket.create_connection((host, port), REACHED).close()
    except OSError as error:
        reason = error.strerror or str(error)
        return Finding(
            what, State.BAD, f"{at}: {reason}", "start it (./CarlaUE4.sh -RenderOffScreen), or name --host, --port"
        )
    done, said = _tried(SERVER, host, str(port), str(REACHED), patience=3 * REACHED)
    if not done:
        return Finding(what, State.BAD, f"{at}: {said}", "see whether it is a CARLA server, and start it anew")
    if said != client:
        return Finding(what, State.BAD, f"{at}: {said}, the client is {client}", f"pip install 'carla=={said}'")
    return Finding(what, State.OK, f"{at}: {said}")


def _tried(code: str, *arguments: str, patience: float = STARTED) -> tuple[bool, str]:
    """Run some code in a process of its own; return whether it ended well, and its last line."""
    command = [sys.executable, "-c", code, *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=patience, check=False)  # noqa: S603
    except subprocess.TimeoutExpired:
        return False, f"no answer within {patience:g} s"
    lines = (done.stderr if done.returncode else done.stdout).strip().splitlines()
    said = lines[-1] if lines else ""
    return not done.returncode, said if not done.returncode else said or f"ended with {done.returncode}"


def _version(package: str) -> str | None:
    try:
        return re.sub(r"\+.*", "", importlib.metadata.version(package))
    except importlib.metadata.PackageNotFoundError:
        return None
