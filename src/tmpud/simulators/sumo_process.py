"""How SUMO is started in this process: which options, on which file, and what can stand in the way."""

from __future__ import annotations

import contextlib
import importlib.metadata
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType

from tmpud.errors import SimulatorError
from tmpud.roads.network import RoadNetwork
from tmpud.simulators.conventions import DT, Closing

OPTIONS = (
    "--no-step-log", "--no-warnings", "--duration-log.disable", "--collision.check-junctions",
    "--collision.mingap-factor", "0", "--time-to-teleport", "-1", "--max-depart-delay", "-1", "--step-length", str(DT),
)  # fmt: skip


def imported() -> ModuleType:
    """Return libsumo; SimulatorError where it is missing. What it says on import goes to stderr."""
    with contextlib.redirect_stdout(sys.stderr):
        try:
            import libsumo
        except ImportError as error:
            raise SimulatorError(f"libsumo cannot be imported ({error}): pip install libsumo") from error
    return libsumo  # type: ignore[no-any-return]


def start(network: RoadNetwork, seed: int, collision_action: str = "none") -> ModuleType:
    """Load the network into libsumo; what it says on import goes to stderr."""
    libsumo = imported()
    if not Path(network.source).is_file():
        raise SimulatorError(f"{network.name}: SUMO needs the map's file, and {network.source!r} is none")
    if network.source.endswith(".xodr"):
        raise SimulatorError(f"{network.name}: SUMO drives on nets; make one: tmpud map import {network.source}")
    if libsumo.isLoaded():
        raise SimulatorError("SUMO holds one simulation per process: close the other, or use a process for each")
    try:
        options = ("--net-file", network.source, "--seed", str(seed % 2**31), "--collision.action", collision_action)
        libsumo.start(["sumo", *options, *OPTIONS])
    except Exception as error:  # libsumo's own class cannot be named before it is imported
        raise SimulatorError(f"SUMO does not start on {network.source}: {error}") from error
    return libsumo


class Simulation(Closing):
    """SUMO in this process, which holds one simulation at a time; it ends with the ``with`` block."""

    _sumo: ModuleType
    _steps = 0

    @property
    def versions(self) -> Mapping[str, str]:
        return {"libsumo": importlib.metadata.version("libsumo")}

    def close(self) -> None:
        """End the simulation; a second call does nothing."""
        if self._sumo.isLoaded():
            self._sumo.close()

    @contextlib.contextmanager
    def _errors(self) -> Iterator[None]:
        """Turn what libsumo raises into SimulatorError that says when it came, and end the simulation."""
        try:
            yield
        except (self._sumo.TraCIException, self._sumo.FatalTraCIError) as error:
            self.close()
            raise SimulatorError(f"SUMO failed after {self._steps} steps: {error}") from error
