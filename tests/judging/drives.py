"""Hand-made drives: positions and speeds as functions of time, turned into scenes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace

from tmpud.dynamics import clamp
from tmpud.geometry import Pose
from tmpud.judging.judge import Judge
from tmpud.judging.rules import Verdict
from tmpud.scene import Scene, Vehicles, VehicleState

STEP = 0.05  # [s]
Motion = Callable[[float], VehicleState]


def car(
    x: float, y: float = 0.0, lane: str = "in_0", speed: float = 5.0, heading: float = 0.0, name: str = "ego"
) -> VehicleState:
    return VehicleState(name, Pose(x, y, heading), lane, speed=speed)


def scene(time: float, ego: VehicleState, *others: VehicleState, signals: Mapping[str, str] | None = None) -> Scene:
    return Scene(time, ego, Vehicles.of(list(others)), signals or {})


def scenes(seconds: float, ego: Motion, *others: Motion) -> Iterator[Scene]:
    """Yield the scenes of a drive, one per step."""
    for i in range(round(seconds / STEP) + 1):
        yield scene(i * STEP, ego(i * STEP), *(other(i * STEP) for other in others))


def judge_all(judge: Judge, drive: Iterable[Scene]) -> list[Verdict]:
    return [verdict for view in drive for verdict in judge.observe(view)]


def slowing(start: VehicleState, brakes_at: float, deceleration: float, down_to: float = 0.0) -> Motion:
    """Return the motion of a car that brakes to a lower speed; it drives straight along the x axis."""

    def motion(time: float) -> VehicleState:
        braking = max(time - brakes_at, 0.0)
        duration = min(braking, (start.speed - down_to) / deceleration)
        speed = start.speed - deceleration * duration
        x = start.pose.x + start.speed * (time - braking)
        x += (start.speed + speed) / 2 * duration + speed * (braking - duration)
        acceleration = -deceleration if 0 < braking <= duration else 0.0
        return replace(start, pose=Pose(x, *start.pose[1:]), speed=speed, acceleration=acceleration)

    return motion


def cruising(start: VehicleState) -> Motion:
    return slowing(start, 1e9, 1.0)


def merging(start: VehicleState, crosses_at: float, y: float, lane: str) -> Motion:
    """Return the motion of a car that changes lanes within two seconds, in the middle of them across the line."""

    def motion(time: float) -> VehicleState:
        here, across = cruising(start)(time), clamp((time - crosses_at + 1) / 2, 0.0, 1.0)
        pose = here.pose._replace(y=start.pose.y + across * (y - start.pose.y))
        return replace(here, pose=pose, lane=lane if across >= 0.5 else start.lane)

    return motion
