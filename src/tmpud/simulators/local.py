"""The small area of the full simulation: an ego and its neighbours on a two-lane road, many times side by side.

Dynamics, time step, SUMO's options and the way the ego is moved are those of ``sumo.py``. Every road reports its scene
in the frame of road 0, so that one network serves planner, estimator and judge of all of them.
"""

from __future__ import annotations

import random
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tmpud.dynamics import EGO, step
from tmpud.errors import SimulatorError
from tmpud.geometry import Pose
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.scene import Control, Scene, Vehicles, VehicleState
from tmpud.simulators import sumo_ego
from tmpud.simulators.cars import TYPE
from tmpud.simulators.conventions import DT, EGO_ID
from tmpud.simulators.local_roads import APART, LANES, WIDTH, lane_name, road_name, write_net
from tmpud.simulators.sumo import JOINT
from tmpud.simulators.sumo_process import Simulation, start
from tmpud.simulators.sumo_reader import SumoReader
from tmpud.simulators.traffic import TrafficRules

CAR_LENGTH = 5.0  # [m] of SUMO's default car
TRAFFIC = TrafficRules()  # the cars are those of the full simulation


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacementLaw:
    """Where the neighbours appear around the ego, how fast, and how they differ from steady drivers."""

    ego_station: float = 79.0  # [m] so that the decision comes at about the middle of a segment
    reach: float = 25.0  # [m] neighbours are uniform within so much before and behind the ego, on either lane
    gap: float = TRAFFIC.min_gap  # [m] at least, between bumpers in one lane
    redraw: float = 1.0  # [s] after so long each neighbour draws a new acceleration factor
    slowest: float = 0.4  # share of the wished speed below which nobody wishes to drive
    fastest: float = 1.6
    settling: float = 2.0  # [s] from the spawning to the decision


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """A road condition of the paper's abstract simulation (Sec. V)."""

    neighbours: int  # density: how many surround the ego
    acceleration: float  # [m/s^2] the factor is uniform within so much either way


@dataclass(slots=True)
class _Neighbour:
    """One car besides the ego: its wish drifts by a random acceleration factor."""

    id: str
    wish: float  # [m/s]
    factor: float = 0.0  # [m/s^2]


class LocalRoads(Simulation):
    """One SUMO with ``roads`` parallel roads, each with an ego and its neighbours; a context manager.

    The acceleration factor is added to a neighbour's wished speed over time; its car-following model bounds what it
    makes of it, so nobody drives into a leader of his own accord.
    """

    def __init__(self, condition: Condition, roads: int, seed: int, law: PlacementLaw | None = None) -> None:
        self._condition, self._law = condition, law or PlacementLaw()
        self._rng = random.Random(f"local/{seed}/{condition.neighbours}/{condition.acceleration}")  # noqa: S311
        self._egos: dict[int, VehicleState] = {}
        self._origins: dict[int, int] = {}
        self._neighbours: dict[int, list[_Neighbour]] = {}
        self._folder = tempfile.TemporaryDirectory(prefix="tmpud-local-")
        try:
            self._sumo = start(read_sumo_net(write_net(Path(self._folder.name), roads)), seed)
        except SimulatorError:
            self._folder.cleanup()
            raise
        self._reader = SumoReader(self._sumo)
        with self._errors():
            self._define_types()
            for road in range(roads):
                self._spawn(road)

    @property
    def scenes(self) -> dict[int, Scene]:
        """What each ego perceives now, in the frame of road 0."""
        with self._errors():
            everyone = self._reader.everyone(self._steps)
            time = round(self._sumo.simulation.getTime(), 3)
        others = _by_road(everyone)
        return {road: Scene(time, ego, others[road], {}) for road, ego in self._egos.items()}

    def step(self, controls: Mapping[int, Control]) -> None:
        """Move each ego that is still there by its command for one step; the others react."""
        with self._errors():
            self._disturb()
            for road, control in controls.items():
                self._egos[road] = step(self._egos[road], control, DT)
                self._place(road)
            self._sumo.simulationStep()
        self._steps += 1
        for road, ego in self._egos.items():
            self._egos[road] = replace(ego, lane=lane_name(0, self._lane(road)))

    def end(self, road: int) -> None:
        """Clear a road whose run is over."""
        with self._errors():
            self._sumo.vehicle.remove(_ego_id(road))
            alive = set(self._sumo.vehicle.getIDList())
            for neighbour in self._neighbours.pop(road):
                if neighbour.id in alive:
                    self._sumo.vehicle.remove(neighbour.id)
        del self._egos[road]

    def close(self) -> None:
        """End the simulation; a second call does nothing."""
        super().close()
        self._folder.cleanup()

    # Spawning --------------------------------------------------------------------------------------------------

    def _define_types(self) -> None:
        types = self._sumo.vehicletype
        types.copy("DEFAULT_VEHTYPE", TYPE)
        types.setMinGap(TYPE, TRAFFIC.min_gap)
        sumo_ego.define(self._sumo, EGO)

    def _spawn(self, road: int) -> None:
        """Put an ego on one of a road's lanes, and its neighbours around it."""
        origin = self._rng.randrange(LANES)
        y = (origin + 0.5 - LANES / 2) * WIDTH
        pose = Pose(self._law.ego_station, y, 0.0)
        self._origins[road], name = origin, road_name(road)
        self._egos[road] = VehicleState(
            EGO_ID, pose, lane_name(0, origin), speed=TRAFFIC.wished_speed, length=EGO.length, width=EGO.width
        )
        self._sumo.route.add(name, [name])
        front = self._law.ego_station + EGO.length / 2
        self._add(_ego_id(road), road, origin, front, TRAFFIC.wished_speed, sumo_ego.TYPE)
        sumo_ego.take_over(self._sumo, _ego_id(road))
        self._neighbours[road] = []
        for number, (lane, centre) in enumerate(self._places(origin)):
            wish = TRAFFIC.wished_speed * self._rng.uniform(1 - TRAFFIC.spread, 1 + TRAFFIC.spread)
            neighbour = _Neighbour(f"{name}.{number}", wish)
            self._add(neighbour.id, road, lane, centre + CAR_LENGTH / 2, wish, TYPE)
            self._sumo.vehicle.setParameter(neighbour.id, "laneChangeModel.lcKeepRight", str(TRAFFIC.keep_right))
            self._neighbours[road].append(neighbour)

    def _add(self, vehicle: str, road: int, lane: int, front: float, speed: float, kind: str) -> None:
        self._sumo.vehicle.add(vehicle, road_name(road), typeID=kind)
        self._sumo.vehicle.moveTo(vehicle, lane_name(road, lane), front)
        self._sumo.vehicle.setPreviousSpeed(vehicle, speed)

    def _places(self, origin: int) -> list[tuple[int, float]]:
        """Draw (lane, station of the centre) of each neighbour; all anew until those of a lane are a gap apart."""
        law = self._law
        while True:
            drawn = [
                (self._rng.randrange(LANES), law.ego_station + self._rng.uniform(-law.reach, law.reach))
                for _ in range(self._condition.neighbours)
            ]
            if _apart([(origin, law.ego_station), *drawn], CAR_LENGTH + law.gap):
                return drawn

    # One step --------------------------------------------------------------------------------------------------

    def _disturb(self) -> None:
        """Let each neighbour's wished speed drift by its acceleration factor."""
        law, bound = self._law, self._condition.acceleration
        redraw = self._steps % round(law.redraw / DT) == 0
        low, high = law.slowest * TRAFFIC.wished_speed, law.fastest * TRAFFIC.wished_speed
        for neighbours in self._neighbours.values():
            for car in neighbours:
                if redraw:
                    car.factor = self._rng.uniform(-bound, bound)
                car.wish = min(max(car.wish + car.factor * DT, low), high)
                self._sumo.vehicle.setMaxSpeed(car.id, car.wish)

    def _place(self, road: int) -> None:
        """Command SUMO to have the ego's front bumper where its pose says after the next step."""
        x, y = sumo_ego.front_bumper(self._egos[road])
        lane = lane_name(road, self._lane(road))
        sumo_ego.move(self._sumo, _ego_id(road), self._egos[road], lane, (x, y + road * APART))

    def _lane(self, road: int) -> int:
        """Return the lane of the ego's front bumper, as ``SumoSimulator`` finds it on the lanes announced to it."""
        _, y = sumo_ego.front_bumper(self._egos[road])
        origin = self._origins[road]
        off = {lane: abs(y - (lane + 0.5 - LANES / 2) * WIDTH) for lane in (origin, 1 - origin)}
        return 1 - origin if off[1 - origin] < min(off.values()) + JOINT else origin


def _ego_id(road: int) -> str:
    return f"{EGO_ID}{road}"


def _apart(places: Sequence[tuple[int, float]], distance: float) -> bool:
    """Whether no two places in the same lane are nearer than this."""
    return all(
        lane != other or abs(station - other_station) >= distance
        for i, (lane, station) in enumerate(places)
        for other, other_station in places[:i]
    )


def _by_road(everyone: Vehicles) -> Mapping[int, Vehicles]:
    """Return each road's vehicles, egos left out, in the frame of road 0."""
    roads = np.rint(everyone.y / APART).astype(int)
    egos = np.array([name.startswith(EGO_ID) for name in everyone.ids], dtype=np.bool_)
    found: dict[int, Vehicles] = {}
    for road in np.unique(roads).tolist():
        there = everyone.take((roads == road) & ~egos)
        lanes = tuple(lane_name(0, int(lane[-1:])) if lane else "" for lane in there.lanes)
        found[road] = Vehicles(there.ids, lanes, [car._replace(y=car.y - road * APART) for car in there.bodies])
    return found
