"""What a simulator reports and accepts: states in SI units, the others one by one and as arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.geometry import Pose

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]  # points and vectors of the plane, x + iy


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

    @property
    def body(self) -> Body:
        x, y, heading = self.pose
        return Body(x, y, self.z, heading, self.speed, self.yaw_rate, self.acceleration, self.length, self.width)


@dataclass(frozen=True, slots=True)
class Control:
    """A command to the ego: <delta, theta> of the paper."""

    acceleration: float  # [m/s^2]
    steering: float  # [rad], positive to the left


class Body(NamedTuple):
    """Where a vehicle is, how it moves and how large it is."""

    x: float  # [m] centre of its box
    y: float  # [m]
    z: float  # [m]
    heading: float  # [rad]
    speed: float  # [m/s]
    yaw_rate: float  # [rad/s]
    acceleration: float  # [m/s^2]
    length: float  # [m]
    width: float  # [m]


class _Column:
    """One value of all bodies (N,), in the unit that Body says."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._index = Body._fields.index(name)

    def __get__(self, vehicles: Vehicles, owner: type) -> FloatArray:
        return vehicles.columns[self._index]


@dataclass(frozen=True, slots=True, eq=False)
class Vehicles:
    """N surrounding vehicles, one by one, and as arrays once somebody asks for one."""

    ids: tuple[str, ...]
    lanes: tuple[str, ...]  # lanes through junctions included; "" where on none
    bodies: Sequence[Body]
    _columns: list[tuple[FloatArray, ...]] = field(default_factory=list, init=False, repr=False)

    x = _Column()
    y = _Column()
    z = _Column()
    heading = _Column()
    speed = _Column()
    yaw_rate = _Column()
    acceleration = _Column()
    length = _Column()
    width = _Column()

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def columns(self) -> tuple[FloatArray, ...]:
        """The bodies as nine arrays (N,)."""
        if not self._columns:
            flat = np.array([*chain.from_iterable(self.bodies)], dtype=np.float64)
            table = flat.reshape(len(self.bodies), len(Body._fields)).T.copy()
            table.flags.writeable = False  # the bodies would not change with it
            self._columns.append(tuple(table))
        return self._columns[0]

    def take(self, keep: NDArray[np.bool_]) -> Vehicles:
        """Return the vehicles at which ``keep`` (N,) is true."""
        index = np.flatnonzero(keep).tolist()
        ids, lanes = (tuple(names[i] for i in index) for names in (self.ids, self.lanes))
        return Vehicles(ids, lanes, [self.bodies[i] for i in index])

    @classmethod
    def of(cls, states: Sequence[VehicleState]) -> Vehicles:
        """Gather single vehicles."""
        return cls(tuple(s.id for s in states), tuple(s.lane for s in states), [s.body for s in states])

    @classmethod
    def of_table(cls, ids: tuple[str, ...], lanes: tuple[str, ...], table: FloatArray) -> Vehicles:
        """Take the bodies from a table (N, 9)."""
        return cls(ids, lanes, [*map(Body._make, table.tolist())])


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
