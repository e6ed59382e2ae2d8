"""What SUMO says of vehicles, in our units: front bumper and compass angle become the box's centre and a heading."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Mapping
from types import ModuleType
from typing import Any

from tmpud.geometry import wrap_angle
from tmpud.scene import Body, Vehicles
from tmpud.simulators.conventions import DT, EGO_ID

YAW_WINDOW = 11  # steps whose headings tell a yaw rate


class SumoReader:
    """Turns libsumo's values into arrays, and measures yaw rates, which SUMO does not know."""

    def __init__(self, sumo: ModuleType) -> None:
        vehicle = sumo.vehicle
        self._sumo = sumo
        self._getters = {
            sumo.VAR_POSITION3D: vehicle.getPosition3D,
            sumo.VAR_ANGLE: vehicle.getAngle,
            sumo.VAR_SPEED: vehicle.getSpeed,
            sumo.VAR_ACCELERATION: vehicle.getAcceleration,
            sumo.VAR_LANE_ID: vehicle.getLaneID,
        }
        self.fields = tuple(self._getters)  # what to subscribe to, in this order
        self._sizes: dict[str, tuple[float, float]] = {}  # vehicle -> length and width [m], which never change
        self._headings: deque[tuple[int, dict[str, float]]] = deque()  # (step, vehicle -> heading), oldest first
        self._signals: dict[str, str] = {}
        self._next_switch = -math.inf  # [s]

    def everyone(self, step: int) -> Vehicles:
        """Return all vehicles but the ego; ``step`` numbers the simulator's steps."""
        ids = self._sumo.vehicle.getIDList()
        return self.vehicles({v: {field: get(v) for field, get in self._getters.items()} for v in ids}, step)

    def vehicles(self, seen: Mapping[str, Mapping[int, Any]], step: int) -> Vehicles:
        """Return vehicles but the ego from SUMO's values, in the order of their ids."""
        position, angle, speed, acceleration, lane = self.fields
        ids = tuple(sorted(seen.keys() - {EGO_ID}))
        headings, sizes = self._headings_at(step), self._sizes
        bodies, lanes = [], []
        for vehicle in ids:
            values = seen[vehicle]
            x, y, z = values[position]
            headings[vehicle] = heading = wrap_angle(math.radians(90.0 - values[angle]))
            length, width = sizes.get(vehicle) or self._size(vehicle)
            x, y = x - length / 2 * math.cos(heading), y - length / 2 * math.sin(heading)
            yaw_rate = self._yaw_rate(vehicle, heading, step)
            moving = values[speed], yaw_rate, values[acceleration]
            bodies.append(Body(x, y, z, heading, *moving, length, width))
            lanes.append(values[lane])
        return Vehicles(ids, tuple(lanes), bodies)

    def signals(self, lights: Iterable[str], time: float) -> Mapping[str, str]:
        """Return what the lights show; the same object as long as none has come to its next switch."""
        if time + DT > self._next_switch:
            trafficlight = self._sumo.trafficlight
            self._signals = {light: trafficlight.getRedYellowGreenState(light) for light in lights}
            self._next_switch = min(map(trafficlight.getNextSwitch, lights), default=math.inf)
        return self._signals

    def _size(self, vehicle: str) -> tuple[float, float]:
        self._sizes[vehicle] = self._sumo.vehicle.getLength(vehicle), self._sumo.vehicle.getWidth(vehicle)
        return self._sizes[vehicle]

    def _headings_at(self, step: int) -> dict[str, float]:
        """Return where to note the headings of this step, and forget those before the window."""
        while self._headings and self._headings[0][0] <= step - YAW_WINDOW:
            self._headings.popleft()
        if not self._headings or self._headings[-1][0] != step:
            self._headings.append((step, {}))
        return self._headings[-1][1]

    def _yaw_rate(self, vehicle: str, heading: float, step: int) -> float:
        """Return the mean yaw rate since the vehicle was first seen within the window [rad/s]."""
        then, seen = self._headings[0]
        if vehicle not in seen:
            then, seen = next(noted for noted in self._headings if vehicle in noted[1])
        return wrap_angle(heading - seen[vehicle]) / ((step - then) * DT) if step > then else 0.0
