"""Whether a CARLA server does what the adapter expects of it, tried thing by thing."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmpud.errors import SimulatorError
from tmpud.geometry import wrap_angle
from tmpud.roads.loading import load_map
from tmpud.roads.network import Lane, RoadNetwork
from tmpud.scene import Control, Scene, Vehicles, VehicleState
from tmpud.simulators.carla.maps import fetch
from tmpud.simulators.carla.session import CLOSED, Address, Session
from tmpud.simulators.carla.signals import DARK
from tmpud.simulators.carla.simulator import CarlaSimulator
from tmpud.simulators.conventions import DT

STATION = 15.0  # [m] of the longest lane, where the ego is tried
AHEAD = 15.0  # [m] before the ego a car is parked to be hit
LIGHTS_CHANGE = 90.0  # [s] in which some light changes
WHEELBASE = 2.9  # [m] about


@dataclass(frozen=True, slots=True)
class Check:
    """One thing that was tried."""

    what: str
    passed: bool
    found: str


def verify(server: Address, name: str, traffic: int, seed: int) -> Iterator[Check]:
    """Try a server on one of its maps; SimulatorError where it cannot be gone on."""
    try:
        before = _left(server)
    except SimulatorError as error:
        yield Check("versions", False, str(error))
        return
    yield Check("versions", True, f"server and client are {before['version']}")
    network = load_map(fetch(server, name))
    yield Check("map", True, f"{network.name}: {len(network.lanes)} lanes, {len(network.signals)} signals")
    with CarlaSimulator(network, traffic=traffic, seed=seed, server=server, warm_up=5.0) as town:
        yield from _settings(town)
        yield from _driving(town, network)
        yield from _town(town, network, traffic)
    yield _collision(server, network)
    hashes = [_positions(server, network, traffic, seed) for _ in range(2)]
    yield Check("repeatable", hashes[0] == hashes[1], f"positions of two runs: {hashes[0]}, {hashes[1]}")
    after = _left(server)
    same = after["settings"] == before["settings"]
    left = f"{after['actors']} of our actors left, settings {'restored' if same else 'changed'}"
    yield Check("left as found", same and not after["actors"], left)


def _left(server: Address) -> dict[str, Any]:
    """Return what a new client sees of settings and of our actors."""
    with closing(Session(server)) as session:
        words = session.ask("look", CLOSED).words
        return {"version": session.version, **words}


def _settings(town: CarlaSimulator) -> Iterator[Check]:
    settings = town.settings()
    good = settings["synchronous_mode"] is True and math.isclose(settings["fixed_delta_seconds"], DT, rel_tol=1e-5)
    step = settings["fixed_delta_seconds"]
    yield Check("settings", good, f"synchronous: {settings['synchronous_mode']}, step: {step:.3f} s")


def _driving(town: CarlaSimulator, network: RoadNetwork) -> Iterator[Check]:
    """Try place, pedals and steering wheel."""
    lane = _longest(network)
    at = lane.centre.pose_at(STATION)
    scene = town.reset(lane.id, STATION)
    away = math.dist(scene.ego.pose[:2], at[:2])
    turned = abs(scene.ego.pose.heading - at.heading)
    placed = away < 0.5 and turned < 0.1 and scene.ego.lane == lane.id
    yield Check("place", placed, f"{away:.2f} m from where it was put, on {scene.ego.lane or 'no lane'}")
    yield Check("stands", abs(scene.ego.speed) < 0.1, f"{scene.ego.speed:.2f} m/s")
    began = scene.time
    scene = _driven(town, Control(2.0, 0.0), 40)
    clock = math.isclose(scene.time - began, 40 * DT, abs_tol=1e-6)
    yield Check("clock", clock, f"40 steps are {scene.time - began:.3f} s")
    yield Check("speeds up", abs(scene.ego.speed - 4.0) < 1.0, f"2 m/s2 for 2 s: {scene.ego.speed:.2f} m/s")
    yield from _steering(town, scene.ego)
    for _ in range(80):
        scene = town.step(Control(-3.0 if scene.ego.speed > 0.1 else 0.0, 0.0))
    yield Check("brakes", abs(scene.ego.speed) < 0.1, f"after 4 s of braking {scene.ego.speed:.2f} m/s")


def _steering(town: CarlaSimulator, ego: VehicleState) -> Iterator[Check]:
    """Try both directions; what we call left is a steer below 0 on the server."""
    for name, sign, angle in (("right", ">", -0.1), ("left", "<", 0.1)):
        after = _driven(town, Control(0.0, angle), 20).ego
        turned = wrap_angle(after.pose.heading - ego.pose.heading)
        right = math.copysign(1.0, turned) == math.copysign(1.0, after.yaw_rate) == math.copysign(1.0, angle)
        there = "left" if turned > 0.0 else "right"
        found = f"steer {sign} 0 turns it {abs(turned):.3f} rad to the {there}, yaw rate {after.yaw_rate:+.3f} rad/s"
        yield Check(f"steers {name}", right, found)
        share = abs(turned) / (math.dist(ego.pose[:2], after.pose[:2]) * math.tan(0.1) / WHEELBASE)
        ego = after
    yield Check("steers enough", 0.6 < share < 1.4, f"{share:.2f} of a bicycle's turn")


def _town(town: CarlaSimulator, network: RoadNetwork, traffic: int) -> Iterator[Check]:
    """Try traffic and lights."""
    seen: set[str] = set()
    first = town.everyone()
    for _ in range(round(LIGHTS_CHANGE / DT) if network.signals else 100):
        scene = town.step(Control(0.0, 0.0))
        seen.add("|".join(scene.signals.values()))
        if len(seen) > 1 and scene.time > 10.0:
            break
    cars = town.everyone()
    yield Check("traffic", len(cars) == traffic, f"{len(cars)} of {traffic} vehicles")
    moved = _moved(first, cars)
    yield Check("traffic moves", moved > 0 or not traffic, f"{moved} of them drove 1 m or more")
    on_lanes = sum(bool(lane) for lane in cars.lanes)
    yield Check("lanes", on_lanes >= 0.9 * len(cars), f"{on_lanes} of {len(cars)} vehicles are on a lane of the map")
    dark = [name for name, letters in scene.signals.items() if DARK in letters]
    yield Check("lights known", not dark, f"{len(scene.signals)} signals, with heads the server lacks: {len(dark)}")
    if network.signals:
        yield Check("lights change", len(seen) > 1, f"within {scene.time:.0f} s")


def _moved(before: Vehicles, after: Vehicles) -> int:
    """Return how many of the vehicles that were there before are elsewhere."""
    places = dict(zip(before.ids, zip(before.x, before.y, strict=True), strict=True))
    now = zip(after.ids, zip(after.x, after.y, strict=True), strict=True)
    return sum(math.dist(places.get(name, place), place) >= 1.0 for name, place in now)


def _collision(server: Address, network: RoadNetwork) -> Check:
    lane = _longest(network)
    with CarlaSimulator(network, traffic=0, seed=1, server=server, warm_up=0.0) as town:
        town.reset(lane.id, STATION)
        town.park(lane.centre.pose_at(STATION + AHEAD))
        for _ in range(200):
            scene = town.step(Control(2.0, 0.0))
            if town.contacts:
                break
        x, y, _ = scene.ego.pose
        gap = min(np.hypot(scene.others.x - x, scene.others.y - y), default=math.inf)
    return Check("collision", len(town.contacts) == 1, f"{len(town.contacts)} told, centres {gap:.1f} m apart")


def _positions(server: Address, network: RoadNetwork, traffic: int, seed: int) -> str:
    """Return a hash of where everyone was in each of 100 steps."""
    told = hashlib.sha256()
    with CarlaSimulator(network, traffic=traffic, seed=seed, server=server, warm_up=1.0) as town:
        town.reset(_longest(network).id, STATION)
        for _ in range(100):
            town.step(Control(1.0, 0.0))
            cars = town.everyone()
            told.update(np.stack([cars.x, cars.y, cars.heading]).tobytes())
    return told.hexdigest()[:12]


def _driven(town: CarlaSimulator, control: Control, steps: int) -> Scene:
    for _ in range(steps):
        scene = town.step(control)
    return scene


def _longest(network: RoadNetwork) -> Lane:
    return max(network.lanes.values(), key=lambda lane: (lane.length, lane.id))
