"""The cars around the ego in SUMO: put on the road, and sent on one trip after another."""

from __future__ import annotations

import math
import random
from types import ModuleType

from tmpud.geometry import Pose
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Vehicles
from tmpud.simulators.conventions import DT, EGO_ID, SENSING_RANGE
from tmpud.simulators.traffic import AHEAD, Circulation, Spot, TrafficRules

TYPE = "car"
ROOM_BEHIND, ROOM_AHEAD, ROOM_BESIDE = 15.0, 25.0, 2.5  # [m] around a place where a vehicle appears
TRIES = 50  # places that are looked at for one car
STUCK = 180.0  # [s] a car that stands for two cycles of the lights is part of a gridlock


class Cars:
    """Some cars in a running simulation. Names are never given twice."""

    def __init__(
        self, sumo: ModuleType, network: RoadNetwork, circulation: Circulation, rules: TrafficRules, rng: random.Random
    ) -> None:
        self._sumo, self._network, self._circulation = sumo, network, circulation
        self._rules, self._rng = rules, rng
        self._locals: set[str] = set()  # cars that stay where the mission goes
        self._count = 0
        sumo.vehicletype.copy("DEFAULT_VEHTYPE", TYPE)
        sumo.vehicletype.setMinGap(TYPE, rules.min_gap)

    def fill(self, spots: list[Spot]) -> None:
        """Put a car on each spot; those on the first, the busiest, are the local ones."""
        local = self._circulation.locals_among(len(spots))
        for number, spot in enumerate(spots):
            self.add(spot, local=number < local)

    def add(self, spot: Spot, *, local: bool) -> None:
        """Put a standing car on the road, with a wished speed of its own and trips to make."""
        vehicle, rules, road = self._sumo.vehicle, self._rules, self._network.lanes[spot.lane].edge
        name = f"car{self._count}"
        self._count += 1
        if local:
            self._locals.add(name)
        self._sumo.route.add(name, [road, *self._circulation.walk(road, local=local)])
        place = {"departLane": str(self._network.lanes[spot.lane].index), "departPos": f"{spot.station:.2f}"}
        vehicle.add(name, name, typeID=TYPE, departSpeed="0", **place)
        vehicle.setMaxSpeed(name, rules.wished_speed * self._rng.uniform(1 - rules.spread, 1 + rules.spread))
        vehicle.setParameter(name, "laneChangeModel.lcKeepRight", str(rules.keep_right))

    def extend_routes(self) -> None:
        """Give every car further trips before it has made all it knows."""
        vehicle = self._sumo.vehicle
        for name in sorted(vehicle.getIDList()):
            if name == EGO_ID:
                continue
            route, at = vehicle.getRoute(name), vehicle.getRouteIndex(name)
            if at >= 0 and len(route) - at < AHEAD // 2:
                more = self._circulation.walk(route[-1], local=name in self._locals)
                vehicle.setRoute(name, [*route[at:], *more])

    def stuck(self, ego: Pose | None) -> list[str]:
        """Return the cars out of the ego's sight that have stood for STUCK seconds."""
        vehicle = self._sumo.vehicle
        stood = [name for name in sorted(vehicle.getIDList()) if vehicle.getWaitingTime(name) >= STUCK]
        return [
            name
            for name in stood
            if ego is None or (name != EGO_ID and math.dist(vehicle.getPosition(name), ego[:2]) > SENSING_RANGE)
        ]

    def passing(self, spot: Spot) -> str | None:
        """Return the car whose centre passed a spot in the last step."""
        vehicle = self._sumo.vehicle
        for name in self._sumo.lane.getLastStepVehicleIDs(spot.lane):
            beyond = vehicle.getLanePosition(name) - vehicle.getLength(name) / 2 - spot.station
            if 0.0 <= beyond < vehicle.getSpeed(name) * DT:
                return str(name)
        return None

    def move(self, name: str, ego: Pose | None, others: Vehicles) -> None:
        """Take a car away; one like it starts where it is free and out of sight, on a very small map anywhere."""
        self._sumo.vehicle.remove(name)
        spots = self._circulation.places(min(TRIES, self._circulation.room))
        for spot in spots:
            pose = self._network.lanes[spot.lane].centre.pose_at(spot.station)
            unseen = ego is None or math.dist(pose[:2], ego[:2]) > SENSING_RANGE
            if unseen and not standing_at(others, pose):
                break
        self.add(spot, local=name in self._locals)


def standing_at(others: Vehicles, pose: Pose) -> list[str]:
    """Return the vehicles so near to a place on the road that no other can appear there."""
    dx, dy = others.x - pose.x, others.y - pose.y
    along = dx * math.cos(pose.heading) + dy * math.sin(pose.heading)
    across = dy * math.cos(pose.heading) - dx * math.sin(pose.heading)
    there = (along > -ROOM_BEHIND) & (along < ROOM_AHEAD) & (abs(across) < ROOM_BESIDE)
    return [others.ids[i] for i in there.nonzero()[0]]
