"""The ego in SUMO: a car without a will of its own, put at each step where its dynamics say."""

from __future__ import annotations

import math
from types import ModuleType

from tmpud.dynamics import VehicleLimits
from tmpud.geometry import Point
from tmpud.scene import VehicleState

TYPE = "ego"


def define(sumo: ModuleType, limits: VehicleLimits) -> None:
    """Tell SUMO the ego's size, once in a simulation."""
    sumo.vehicletype.copy("DEFAULT_VEHTYPE", TYPE)
    sumo.vehicletype.setLength(TYPE, limits.length)
    sumo.vehicletype.setWidth(TYPE, limits.width)


def take_over(sumo: ModuleType, name: str) -> None:
    """Switch off SUMO's own ideas of a vehicle's speed and lane."""
    sumo.vehicle.setSpeedMode(name, 0)
    sumo.vehicle.setLaneChangeMode(name, 0)


def front_bumper(ego: VehicleState) -> Point:
    """Return the middle of the front bumper [m], which SUMO takes for a vehicle's position."""
    x, y, heading = ego.pose
    return x + ego.length / 2 * math.cos(heading), y + ego.length / 2 * math.sin(heading)


def move(sumo: ModuleType, name: str, ego: VehicleState, lane: str, to: Point) -> None:
    """Command SUMO to have the front bumper at a point after the next step.

    SUMO is told the lane, which it would guess wrong where ways through a junction run side by side.
    """
    edge, _, index = lane.rpartition("_")
    angle = 90.0 - math.degrees(ego.pose.heading)
    sumo.vehicle.moveToXY(name, edge, int(index), *to, angle, keepRoute=2)
    sumo.vehicle.setSpeed(name, ego.speed)
