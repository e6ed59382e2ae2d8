"""Stand-ins for the parts the estimator is given, and short ways to set up a scene."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tmpud.geometry import Pose
from tmpud.scene import Control, Scene, Vehicles, VehicleState
from tmpud.symbols import Action, State, Transition
from tmpud.trajectory import Trajectory

FORWARD = Transition(State("in_0/0", 0), Action.FORWARD, State("in_0/1", 0))
MERGELEFT = Transition(State("in_0/0", 0), Action.MERGELEFT, State("in_1/1", 0))


@dataclass(frozen=True)
class FakeMotion:
    """Drives a circle of curvature ``curvature`` [1/m], straight on by default, at the ego's own or a given speed."""

    curvature: float = 0.0
    length: float = 50.0  # [m]
    path: tuple[str, ...] = ("in_0",)

    def path_length(self, transition: Transition) -> float:  # noqa: ARG002
        return self.length

    def lanes(self, transition: Transition) -> tuple[str, ...]:  # noqa: ARG002
        return self.path

    def trajectory(
        self,
        transition: Transition,  # noqa: ARG002
        scene: Scene,
        times: Iterable[float],
        speed: float | None = None,
    ) -> Trajectory:
        instants = np.fromiter(times, dtype=np.float64)
        v = scene.ego.speed if speed is None else speed
        x, y, heading = scene.ego.pose
        turned = self.curvature * v * instants
        chord = v * instants * np.sinc(turned / 2 / np.pi)
        mid = heading + turned / 2
        poses = np.stack([x + chord * np.cos(mid), y + chord * np.sin(mid), heading + turned], axis=-1)
        return Trajectory(instants, poses, np.full_like(instants, v))

    def control(self, scene: Scene) -> Control:  # noqa: ARG002
        return Control(0.0, 0.0)


def car(x: float, y: float, heading: float = 0.0, speed: float = 5.0, name: str = "", lane: str = "") -> VehicleState:
    """Return a car that drives straight on."""
    return VehicleState(name or f"{x:g},{y:g}", Pose(x, y, heading), lane, speed=speed)


def scene(*others: VehicleState, ego: VehicleState | None = None) -> Scene:
    """Return a scene around an ego that drives eastwards at 5 m/s, at (20, 0) unless given."""
    return Scene(0.0, ego or car(20.0, 0.0, name="ego", lane="in_0"), Vehicles.of(list(others)), {})


def mirrored(vehicle: VehicleState) -> VehicleState:
    """Reflect a vehicle at the x axis."""
    x, y, heading = vehicle.pose
    pose = Pose(x, -y, -heading if heading != math.pi else heading)
    return VehicleState(vehicle.id, pose, vehicle.lane, speed=vehicle.speed, yaw_rate=-vehicle.yaw_rate)
