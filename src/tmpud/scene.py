"""What a simulator reports and accepts: states in SI units, the others as one structure of arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from tmpud.geometry import Pose

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class VehicleState:
    """One vehicle, usually the ego."""

    id: str
    pose: Pose  # centre of its box
    lane: str  # lane it is on; "" where it is on none
    z: float = 0.0  # [m]
    speed: float = 0.0  # [m/s]
    yaw_rate: float = 0.0  # [rad/s]
    acceleration: float = 0.0  # [m/s^2]
    length: float = 4.7  # [m]
    width: float = 1.9  # [m]


@dataclass(frozen=True, slots=True)
class Control:
    """A command to the ego: <delta, theta> of the paper."""

    acceleration: float  # [m/s^2]
    steering: float  # [rad], positive to the left


@dataclass(frozen=True, slots=True, eq=False)
class Vehicles:
    """N surrounding vehicles, each field of shape (N,)."""

    ids: tuple[str, ...]
    lanes: tuple[str, ...]  # lanes through junctions included; "" where on none
    x: FloatArray  # [m] centre of the box
    y: FloatArray  # [m]
    z: FloatArray  # [m]
    heading: FloatArray  # [rad]
    speed: FloatArray  # [m/s]
    yaw_rate: FloatArray  # [rad/s]
    acceleration: FloatArray  # [m/s^2]
    length: FloatArray  # [m]
    width: FloatArray  # [m]

    def __len__(self) -> int:
        return len(self.ids)

    def take(self, keep: NDArray[np.bool_]) -> Vehicles:
        """Return the vehicles at which ``keep`` (N,) is true."""
        index = np.flatnonzero(keep)
        arrays = {name: getattr(self, name)[index] for name in _ARRAYS}
        return Vehicles(ids=tuple(self.ids[i] for i in index), lanes=tuple(self.lanes[i] for i in index), **arrays)

    @classmethod
    def of(cls, states: list[VehicleState]) -> Vehicles:
        """Gather single vehicles into arrays."""
        rows = [
            (s.pose.x, s.pose.y, s.z, s.pose.heading, s.speed, s.yaw_rate, s.acceleration, s.length, s.width)
            for s in states
        ]
        return cls.of_rows(tuple(s.id for s in states), tuple(s.lane for s in states), rows)

    @classmethod
    def of_rows(cls, ids: tuple[str, ...], lanes: tuple[str, ...], rows: Sequence[tuple[float, ...]]) -> Vehicles:
        """Gather rows of x, y, z, heading, speed, yaw rate, acceleration, length and width into arrays."""
        shape = len(ids), len(_ARRAYS)
        flat = np.array([*chain.from_iterable(rows)], dtype=np.float64)
        return cls(ids, lanes, *flat.reshape(shape).T.copy())


_ARRAYS = ("x", "y", "z", "heading", "speed", "yaw_rate", "acceleration", "length", "width")


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """All that the ego perceives at one instant."""

    time: float  # [s] simulated
    ego: VehicleState
    others: Vehicles
    signals: Mapping[str, str]  # id of the light -> one letter per link (G, g, y, r, ...)


class Outcome(StrEnum):
    """How the execution of one action ended."""

    DONE = "done"
    COLLIDE = "collide"
    BLOCKED = "blocked"  # stood too long
    TIME_LIMIT = "time limit"
    INFEASIBLE = "infeasible"  # no path does the action; nothing was driven
    INVALID = "invalid state"  # a state or command was refused; the independent brake took over
