"""Steps of CARLA's real client on the tests' loopback server: what our side of a step costs.

    python -m benchmarks carla --vehicles 120 --steps 300 --rounds 3

The server is the loopback kinematic server, not CARLA: its own time is part of each step, a real one's physics and
rendering are not. Each round is a session of its own; the time is that of its steps on the clock, as three processes
wait for each other. It is skipped where the client is not installed.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from benchmarks.harness import Result, need

TOWN = "millbrook"
DRIVEN, READ = "step", "step, all vehicles read"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--vehicles", type=int, default=120, help="default: 120")
    parser.add_argument("--steps", type=int, default=300, help="default: 300")
    parser.add_argument("--rounds", type=int, default=3, help="default: 3")


def measure(asked: argparse.Namespace) -> list[Result]:
    need("carla")
    need("msgpack")
    from tests.carla_loopback.towns import as_opendrive
    from tmpud.roads.loading import map_file

    times: dict[str, list[float]] = {DRIVEN: [], READ: []}
    with tempfile.TemporaryDirectory() as folder:
        xodr = as_opendrive(map_file(TOWN), Path(folder))
        for _ in range(asked.rounds):
            for name in times:
                times[name].append(_session(xodr, asked.vehicles, asked.steps, read=name == READ))
    facts = {"vehicles": asked.vehicles, "steps": asked.steps}
    title = f"{asked.steps} steps of CARLA's client on the loopback kinematic server, {asked.vehicles} vehicles"
    return [Result(title, DRIVEN, times, clock="wall-clock time", facts=facts, batch=(asked.steps, "steps"))]


def _session(xodr: Path, vehicles: int, steps: int, *, read: bool) -> float:
    """Return the time that the steps of one session take [s]."""
    from tests.carla_loopback.running import loopback
    from tmpud.roads import load_map
    from tmpud.scene import Control
    from tmpud.simulators.carla.session import Address
    from tmpud.simulators.carla.simulator import CarlaSimulator

    network = load_map(TOWN)
    with loopback(xodr) as server:
        at = Address(port=server.port)
        with CarlaSimulator(network, traffic=vehicles, seed=1, server=at, warm_up=2.0) as town:
            town.reset("park1e_0", 20.0)
            began = time.perf_counter()
            for _ in range(steps):
                town.step(Control(0.0, 0.0))
                if read:
                    town.everyone()
            return time.perf_counter() - began
