"""How a command's simulator is found: SUMO is here, CARLA a server that has its maps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmpud.cli.options import Sim, Simulated

if TYPE_CHECKING:
    from tmpud.runner import SimulatorFactory
    from tmpud.simulators.carla.session import Address


def simulator(where: Simulated) -> SimulatorFactory:
    """Return what starts the simulator that was asked for."""
    from tmpud.runner import carla, sumo

    return sumo if where.sim is Sim.SUMO else carla(address(where))


def address(where: Simulated) -> Address:
    from tmpud.simulators.carla.session import Address

    return Address(host=where.host, port=where.port)


def server_of(where: Simulated) -> str:
    """Return the name of the CARLA server that is asked for, "" where SUMO drives."""
    return "" if where.sim is Sim.SUMO else str(address(where))


def map_of(where: Simulated, name: str) -> str:
    """Return the map that a name stands for: with CARLA a file of what the server has by that name."""
    from tmpud.simulators.carla.maps import fetch

    return name if where.sim is Sim.SUMO else fetch(address(where), name)
