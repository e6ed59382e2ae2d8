"""Traffic lights of the loopback server: those of a junction turn green one after the other."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable
from typing import NamedTuple

from tests.carla_loopback.bodies import Body, Kind

RED, YELLOW, GREEN = 0, 1, 2
GREEN_TIME, YELLOW_TIME, RED_TIME = 10.0, 3.0, 2.0  # [s] of one light's turn
REACH, BESIDE = 12.0, 2.0  # [m] before its stop line and beside it a vehicle is at a light


class Light(NamedTuple):
    """One head: where its stop line is, and whose turn it shares."""

    sign: str  # its id in the map
    x: float  # [m]
    y: float
    yaw: float  # [deg] of the traffic that it holds up
    turn: int  # 0 or 1: heads of the same turn are green together


def place_lights(lights: list[Light], new_id: Callable[[], int]) -> list[Body]:
    """Return an actor for each head."""
    return [
        Body(new_id(), Kind.LIGHT, (9, "traffic.traffic_light", []), x=light.x, y=light.y, yaw=light.yaw,
             sign=light.sign, place=light)
        for light in lights
    ]  # fmt: skip


def look(lights: list[Body], vehicles: list[Body], time: float) -> None:
    """Set what each light shows, and for each vehicle the light that it is at."""
    by_cell: dict[tuple[int, int], list[Body]] = defaultdict(list)
    for light in lights:
        light.light_state = _state(light.place, time)
        column, row = _cell(light)
        for cell in [(column + dx, row + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]:
            by_cell[cell].append(light)
    for vehicle in vehicles:
        ahead = next((light for light in by_cell.get(_cell(vehicle), ()) if _is_at(vehicle, light)), None)
        vehicle.at_light = ahead.id if ahead else None
        vehicle.light_state = ahead.light_state if ahead else GREEN


def _state(light: Light, time: float) -> int:
    turn = GREEN_TIME + YELLOW_TIME + RED_TIME
    into = (time - light.turn * turn) % (2 * turn)
    return GREEN if into < GREEN_TIME else YELLOW if into < GREEN_TIME + YELLOW_TIME else RED


def _cell(body: Body) -> tuple[int, int]:
    return int(body.x // REACH), int(body.y // REACH)


def _is_at(vehicle: Body, light: Body) -> bool:
    dx, dy = light.x - vehicle.x, light.y - vehicle.y
    yaw = math.radians(light.yaw)
    along, across = dx * math.cos(yaw) + dy * math.sin(yaw), dy * math.cos(yaw) - dx * math.sin(yaw)
    return -1.0 < along < REACH and abs(across) < BESIDE
