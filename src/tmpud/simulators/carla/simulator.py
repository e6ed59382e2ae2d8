"""CARLA as a Simulator: a town on a server, around an ego that moves by the server's physics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmpud.dynamics import within_limits
from tmpud.errors import InvalidStateError, SimulatorError
from tmpud.geometry import Pose
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control, FloatArray, Scene, Vehicles, VehicleState
from tmpud.simulators.carla.lanes import LaneFinder
from tmpud.simulators.carla.messages import COLUMNS, Message
from tmpud.simulators.carla.session import LOADED, MARGIN, Address, Session
from tmpud.simulators.carla.signals import Signals
from tmpud.simulators.conventions import DT, EGO_ID, SENSING_RANGE, Closing
from tmpud.simulators.traffic import TrafficRules

WARM_UP = 30.0  # [s] simulated
CHUNK = 20  # steps between two signs of life while the traffic warms up; all take less than two slow ones


class CarlaSimulator(Closing):
    """One town with circulating traffic, on a map of the server's that is called like the network."""

    def __init__(
        self,
        network: RoadNetwork,
        *,
        traffic: int,
        seed: int,
        server: Address | None = None,
        warm_up: float = WARM_UP,
    ) -> None:
        """Load the map anew and let ``traffic`` vehicles circulate for ``warm_up`` simulated seconds."""
        self._network, self._finder, self._signals = network, LaneFinder(network), Signals(network)
        self._lanes: dict[str, str] = {}  # vehicle -> the lane it was last seen on
        self._names: dict[int, str] = {}  # the server's id -> ours, in the order of appearance
        self._way: frozenset[str] = frozenset()  # the announced lanes
        self._entered, self._zero = False, 0
        self._shift = np.zeros(COLUMNS)  # from the server's coordinates to the network's
        self._shift[:2] = network.frame.offset
        self.contacts: list[tuple[float, str]] = []  # what the collision sensor told, once for each other
        rules = TrafficRules()
        self._session = Session(server or Address())
        words = {"speed": rules.wished_speed, "spread": rules.spread, "min_gap": rules.min_gap}
        try:
            self._take(self._session.load("load", name=network.name, seed=seed, traffic=traffic, rules=words))
            for _ in range(round(warm_up / DT / CHUNK)):
                self._take(self._session.ask("warm_up", 2 * (self._session.patience + MARGIN), steps=CHUNK))
        except SimulatorError:
            self.close()
            raise
        self._zero = self._frame  # of our clock

    # The Simulator protocol ------------------------------------------------------------------------------------

    @property
    def versions(self) -> Mapping[str, str]:
        return {"carla": self._session.version}

    def reset(self, lane: str, station: float) -> Scene:
        """Put the ego on a lane, standing, as soon as there is room."""
        if lane not in self._network.lanes:
            raise SimulatorError(f"{self._network.name} has no lane {lane}")
        self._way = frozenset([lane])
        self._put("enter", self._network.lanes[lane].centre.pose_at(station))
        self._entered = True
        return self._scene()

    def step(self, control: Control) -> Scene:
        """Command the ego, let the server take one step, and return what there is now."""
        if not self._entered:
            raise SimulatorError("step() before reset()")
        if not within_limits(control):
            raise InvalidStateError(f"command {control} is not within the vehicle's limits")
        self._take(self._session.step(control.acceleration, control.steering))
        return self._scene()

    def announce(self, lanes: Sequence[str]) -> None:
        """Take note of the ego's way; the Traffic Manager cannot be told, its cars see where the ego goes."""
        self._way = frozenset(lanes)

    def everyone(self) -> Vehicles:
        """Return all other vehicles of the town, for pictures and records."""
        return self._vehicles(np.arange(self._first, len(self._table)))

    # For tests and ``carla verify`` ------------------------------------------------------------------------------

    def park(self, pose: Pose) -> None:
        """Put a car there that stands for ever; one step passes."""
        self._put("park", pose)

    def settings(self) -> dict[str, Any]:
        """Return the server's settings, as far as they are put back in the end."""
        settings: dict[str, Any] = self._session.ask("look", self._session.patience).words["settings"]
        return settings

    @property
    def process(self) -> int:
        """Return the id of the process that holds CARLA's client."""
        return self._session.process

    def close(self) -> None:
        """Leave the server as it was found; a second call does nothing."""
        self._session.close()

    # Inside ----------------------------------------------------------------------------------------------------

    @property
    def _first(self) -> int:
        """Return the row of the first of the others: the ego's is before them."""
        return 1 if self._entered else 0

    def _put(self, what: str, pose: Pose) -> None:
        """Ask for something to be put at a pose of the network's."""
        x, y = pose[:2] - self._shift[:2]
        self._take(self._session.ask(what, LOADED, x=float(x), y=float(y), heading=pose.heading))

    def _take(self, message: Message) -> None:
        """Take in what the server shows after a step."""
        words, table = message
        self._table = table + self._shift
        self._ids: list[int] = words["ids"]
        self._frame: int = words["frame"]
        for actor in self._ids:
            self._names.setdefault(actor, f"car{len(self._names):04d}")
        if words["lights"] is not None:
            self._signals.update(words["lights"])
        for frame, other in words.get("contacts", ()):
            self.contacts.append(((frame - self._zero) * DT, self._names.get(other, f"object{other}")))

    def _scene(self) -> Scene:
        others = self._table[1:]
        ego = self._table[0]
        near = np.hypot(others[:, 0] - ego[0], others[:, 1] - ego[1]) <= SENSING_RANGE
        time = round((self._frame - self._zero) * DT, 3)
        return Scene(time, self._ego(ego), self._vehicles(1 + near.nonzero()[0]), self._signals.letters)

    def _ego(self, row: FloatArray) -> VehicleState:
        x, y, z, heading, *rest = row.tolist()
        pose = Pose(x, y, heading)
        return VehicleState(EGO_ID, pose, self._finder.lane(pose, z, self._way), z, *rest)

    def _vehicles(self, rows: NDArray[np.intp]) -> Vehicles:
        """Return the vehicles of some rows of the table."""
        names = tuple(self._names[self._ids[row]] for row in rows.tolist())
        table = self._table[rows]
        for name, (x, y, z, heading) in zip(names, table[:, :4].tolist(), strict=True):
            self._lanes[name] = self._finder.lane(Pose(x, y, heading), z, (self._lanes.get(name, ""),))
        return Vehicles.of_table(names, tuple(self._lanes[name] for name in names), table)
