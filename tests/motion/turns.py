"""Drives every turn of a map without traffic and measures how well."""

from __future__ import annotations

import math
from typing import NamedTuple

from tmpud.dynamics import step
from tmpud.geometry import Polyline
from tmpud.motion.path import Cross, Follow
from tmpud.motion.route import build_route
from tmpud.motion.speed import acceleration
from tmpud.motion.tracking import Tracker
from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.scene import VehicleState
from tmpud.symbols import Action

DT = 0.05  # [s]


class Driven(NamedTuple):
    """How one turn was driven."""

    turn: str
    rms: float  # [m] of the centre's distance from the map's own path
    lateral_acceleration: float  # [m/s^2] greatest
    speed: float  # [m/s] greatest


def drive_every_turn(network: RoadNetwork) -> list[Driven]:
    """Drive each left and right turn of a map, from 30 m before it to 15 m behind it as far as the lanes go."""
    turns = (c for c in network.connections if c.action is not Action.FORWARD)
    return [_drive(network, turn) for turn in turns]


def _drive(network: RoadNetwork, turn: LaneConnection) -> Driven:
    before, after = network.lanes[turn.from_lane], network.lanes[turn.to_lane]
    approach = Follow(before, max(before.length - 30.0, 0.0), before.length)
    route = build_route(network, (approach, Cross(turn)), (Follow(after, 0.0, min(15.0, after.length)),))
    line = Polyline([*before.centre.points, *turn.path.points, *after.centre.points])
    ego = VehicleState("ego", route.pose_at(0.0), before.id, speed=float(route.speed_limit[0]))
    tracker, station = Tracker(route), 0.0
    errors, lateral, speeds = [], [0.0], [0.0]
    for _ in range(round(60 / DT)):
        station, offset = route.project(ego.pose.x, ego.pose.y, station)
        if station >= route.length - 1.0:
            break
        command = tracker.control(ego, station, offset, acceleration(route, station, ego.speed, [], None), DT)
        ego = step(ego, command, DT)
        errors.append(line.project(ego.pose.x, ego.pose.y)[1])
        lateral.append(abs(ego.speed * ego.yaw_rate))
        speeds.append(ego.speed)
    return Driven(f"{turn.from_lane} -> {turn.to_lane}", _rms(errors), max(lateral), max(speeds))


def _rms(errors: list[float]) -> float:
    return math.sqrt(sum(e * e for e in errors) / len(errors))
