"""SUMO with cars put beside the ego when it appears."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tmpud.protocols import Simulator
from tmpud.roads.network import RoadNetwork
from tmpud.runner import Mission, SimulatorFactory
from tmpud.scene import Scene
from tmpud.simulators.sumo import SumoSimulator


class Neighbour(NamedTuple):
    lane: str
    ahead: float  # [m] of the ego's centre, its own front bumper
    speed: float  # [m/s] at first
    wished: float  # [m/s]


class CrowdedSumo(SumoSimulator):
    """SUMO as it is, and some cars more."""

    neighbours: Sequence[Neighbour] = ()

    def reset(self, lane: str, station: float) -> Scene:
        super().reset(lane, station)
        vehicle = self._sumo.vehicle
        for i, (where, ahead, speed, wished) in enumerate(self.neighbours):
            name, road = f"beside{i}", self._network.lanes[where].edge
            self._sumo.route.add(name, [road, *self._circulation.walk(road)])
            vehicle.add(name, name, departLane=where.rpartition("_")[2], departPos=str(station + ahead))
            vehicle.moveTo(name, where, station + ahead)
            vehicle.setLaneChangeMode(name, 0)
            vehicle.setMaxSpeed(name, wished)
            vehicle.setPreviousSpeed(name, speed)
        assert self._ego is not None
        self._place(self._ego)
        self._advance()
        return self._scene()


def among(*neighbours: Neighbour) -> SimulatorFactory:
    """Return what makes the simulator with these cars, and no warm-up."""
    crowded = type("Crowded", (CrowdedSumo,), {"neighbours": neighbours})

    def make(network: RoadNetwork, mission: Mission) -> Simulator:
        town: Simulator = crowded(network, traffic=mission.traffic, seed=mission.seed, warm_up=0.0)
        return town

    return make
