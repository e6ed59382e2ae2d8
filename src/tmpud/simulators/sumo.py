"""SUMO in this process (libsumo): real traffic around an ego that moves by its own dynamics.

SUMO speaks of the front bumper and of angles clockwise from north; both are converted here and
in ``sumo_reader.py``, and nowhere else.
"""

from __future__ import annotations

import contextlib
import math
import random
from collections.abc import Sequence
from typing import Any

from tmpud.dynamics import EGO, VehicleLimits, step
from tmpud.errors import SimulatorError
from tmpud.geometry import Polyline, Pose
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control, Scene, Vehicles, VehicleState
from tmpud.simulators import sumo_ego
from tmpud.simulators.cars import Cars, standing_at
from tmpud.simulators.conventions import DT, EGO_ID, SENSING_RANGE
from tmpud.simulators.sumo_process import Simulation, start
from tmpud.simulators.sumo_reader import SumoReader
from tmpud.simulators.traffic import Circulation, Spot, TrafficRules
from tmpud.symbols import ServiceRequest

LOOK_AFTER = 100  # steps between looks at the cars' routes, and for those that are stuck
CYCLE = 90.0  # [s] about one cycle of the lights
PATIENCE = 60.0  # [s] simulated
JOINT = 0.3  # [m] two lanes that meet are equally near to a point this near to their joint
NEXT_LANES = 4  # how many of the announced lanes the ego may be on within one step
GENTLE = 2.0  # [m/s^2] braking


class SumoSimulator(Simulation):
    """One town with circulating traffic. libsumo holds one simulation per process."""

    collision_action = "none"  # what SUMO does where its own cars collide

    def __init__(
        self,
        network: RoadNetwork,
        *,
        traffic: int,
        seed: int,
        warm_up: float = 180.0,
        request: ServiceRequest | None = None,
        rules: TrafficRules | None = None,
    ) -> None:
        """Load the map and let ``traffic`` vehicles circulate for ``warm_up`` simulated seconds, and up to CYCLE more.

        How much more is drawn by the seed, so that the ego meets the lights in any phase. They go where the request
        does, or everywhere without one.
        """
        self._network = network
        self._limits: VehicleLimits = EGO
        self._rng = random.Random(f"traffic/{seed}")  # noqa: S311
        self._rules = rules or TrafficRules()
        self._circulation = Circulation(network, self._rng, request, self._rules)
        self._ego: VehicleState | None = None
        self._roads: list[str] = []  # the announced roads
        self._way: list[tuple[str, Polyline]] = []  # the announced lanes ...
        self._at = 0  # ... and on which of them the ego is
        self._lines: dict[str, Polyline | None] = {}
        places = self._circulation.places(traffic)
        self._sumo = start(network, seed, self.collision_action)
        self._reader = SumoReader(self._sumo)
        with self._errors():
            self._cars = Cars(self._sumo, network, self._circulation, self._rules, self._rng)
            self._cars.fill(places)
            for _ in range(round((warm_up + self._rng.uniform(0.0, CYCLE)) / DT)):
                self._advance()

    # The Simulator protocol ------------------------------------------------------------------------------------

    def reset(self, lane: str, station: float) -> Scene:
        """Put the ego on a lane at the speed of the flow, or such that it could stop before the lane ends."""
        with self._errors():
            return self._appear(lane, station)

    def step(self, control: Control) -> Scene:
        """Move the ego by one command, let the others react, and return what there is now."""
        if self._ego is None:
            raise SimulatorError("step() before reset()")
        self._ego = step(self._ego, control, DT, self._limits)
        with self._errors():
            self._place(self._ego)
            self._advance()
            return self._scene()

    def announce(self, lanes: Sequence[str]) -> None:
        """Tell the others by which lanes the ego means to go on, so that they give way to it at junctions."""
        self._way, self._at = [(lane, line) for lane in dict.fromkeys(lanes) if (line := self._line(lane))], 0
        way = [lane for lane in lanes if lane in self._network.lanes]
        way += self._onward(way[-1])
        roads = [self._network.lanes[lane].edge for lane in way]
        self._roads = [road for road, before in zip(roads, [None, *roads], strict=False) if road != before]

    def everyone(self) -> Vehicles:
        """Return all other vehicles of the town, for pictures and records."""
        return self._reader.everyone(self._steps)

    # Inside ----------------------------------------------------------------------------------------------------

    def _appear(self, lane: str, station: float) -> Scene:
        pose = self._network.lanes[lane].centre.pose_at(station)
        car = self._await(Spot(lane, station))
        leaving = [car] if car else self._standing(pose)
        edge = self._network.lanes[lane].edge
        index = self._network.lanes[lane].index
        sumo_ego.define(self._sumo, self._limits)
        self._sumo.route.add("ego", [edge])
        self._sumo.vehicle.add(EGO_ID, "ego", typeID=sumo_ego.TYPE, departLane=str(index), departPos=f"{station:.2f}")
        sumo_ego.take_over(self._sumo, EGO_ID)
        room = self._network.lanes[lane].length - station - self._limits.length
        speed = min(self._rules.wished_speed, self._network.lanes[lane].speed, math.sqrt(2 * GENTLE * max(room, 0.0)))
        speed = min(speed, self._sumo.vehicle.getSpeed(car)) if car else speed
        self._way, self._at, self._roads = [(lane, self._network.lanes[lane].centre)], 0, [edge]
        self._ego = VehicleState(EGO_ID, pose, lane, speed=speed, length=self._limits.length, width=self._limits.width)
        self._place(self._ego)
        self._advance()
        for name in leaving:  # not sooner, or another would change lanes into the gap
            self._cars.move(name, pose, self.everyone())
        self._sumo.vehicle.subscribeContext(
            EGO_ID, self._sumo.CMD_GET_VEHICLE_VARIABLE, SENSING_RANGE, self._reader.fields
        )
        self._place(self._ego)
        self._advance()
        return self._scene()

    def _await(self, spot: Spot) -> str | None:
        """Wait for a car that passes the ego's place and return it; None where none comes.

        The ego takes its place, and begins as one of the cars in the flow, not in a gap long enough to appear in.
        """
        for _ in range(round(PATIENCE / DT) if self._sumo.vehicle.getIDCount() else 0):
            if name := self._cars.passing(spot):
                return name
            self._advance()
        return None

    def _onward(self, lane: str, roads: int = 2) -> list[str]:
        """Return some lanes that follow a lane: SUMO takes away a vehicle that comes to the end of its route."""
        found: list[str] = []
        while len(found) < roads and (following := self._network.leads_to(lane)):
            lane = following[0]
            found.append(lane)
        return found

    def _line(self, lane: str) -> Polyline | None:
        """Return a lane's centre line, None for one within a junction that has no length."""
        if lane not in self._lines:
            points = [point[:2] for point in self._sumo.lane.getShape(lane)]
            self._lines[lane] = Polyline(points) if len(set(points)) > 1 else None
        return self._lines[lane]

    def _keep_route(self) -> None:
        """Give SUMO the announced route where it has another, or try again at the next step.

        SUMO takes a route only from the road on which it sees the ego, or, too near that road's end to stop, from the
        next one; and within a junction none that leaves it by another way.
        """
        if self._sumo.vehicle.getRoute(EGO_ID)[-1] == self._roads[-1]:
            return
        for first in range(len(self._roads)):
            with contextlib.suppress(self._sumo.TraCIException):
                self._sumo.vehicle.setRoute(EGO_ID, self._roads[first:])
                return

    def _place(self, ego: VehicleState) -> None:
        """Command SUMO to have the ego's front bumper where its pose says after the next step."""
        self._keep_route()
        front = sumo_ego.front_bumper(ego)
        self._at = self._nearest(*front)
        sumo_ego.move(self._sumo, EGO_ID, ego, self._way[self._at][0], front)

    def _nearest(self, x: float, y: float) -> int:
        """Return which of the announced lanes is nearest to a point, the last of those that are equally near.

        Only the next ones are looked at, and the one before.
        """
        offsets = {self._at: abs(self._way[self._at][1].project(x, y)[1])}
        near = offsets[self._at] + JOINT
        for i in range(max(self._at - 1, 0), min(self._at + NEXT_LANES, len(self._way))):
            line = self._way[i][1]
            if i != self._at and line.least_distance(x, y) < near:
                offsets[i] = abs(line.project(x, y)[1])
        near = min(offsets.values()) + JOINT
        return max(i for i, offset in offsets.items() if offset < near)

    def _advance(self) -> None:
        self._sumo.simulationStep()
        self._steps += 1
        if self._steps % LOOK_AFTER == 0:
            self._cars.extend_routes()
            ego = self._ego.pose if self._ego else None
            for name in self._cars.stuck(ego):  # SUMO's cars do not turn back from a gridlock
                self._cars.move(name, ego, self.everyone())

    def _standing(self, pose: Pose) -> list[str]:
        """Wait until the ego's place is free, at most PATIENCE seconds, and return who stands there then."""
        for _ in range(round(PATIENCE)):
            if not standing_at(self.everyone(), pose):
                break
            for _ in range(round(1 / DT)):
                self._advance()
        return standing_at(self.everyone(), pose)

    def _scene(self) -> Scene:
        seen: dict[str, dict[int, Any]] = self._sumo.vehicle.getContextSubscriptionResults(EGO_ID)
        # SUMO may for one step find the ego on no lane: then it is not seen from itself, and yet in the simulation
        if self._ego is None or (EGO_ID not in seen and EGO_ID not in self._sumo.vehicle.getIDList()):
            raise SimulatorError("the ego vanished from the simulation")
        z = self._sumo.vehicle.getPosition3D(EGO_ID)[2]
        ego, lane = self._ego, self._way[self._at][0]
        self._ego = VehicleState(
            EGO_ID, ego.pose, lane, z, ego.speed, ego.yaw_rate, ego.acceleration, ego.length, ego.width
        )
        time = round(self._sumo.simulation.getTime(), 3)
        signals = self._reader.signals(self._network.signals, time)
        return Scene(time, self._ego, self._reader.vehicles(seen, self._steps), signals)
