"""One drive on a server: traffic, ego, lights and contacts, each step of them."""

from __future__ import annotations

import contextlib
import random
from typing import Any

from tmpud.geometry import Pose
from tmpud.scene import FloatArray, Vehicles
from tmpud.simulators.carla.ego import SETTLING, Ego
from tmpud.simulators.carla.lights import Lights
from tmpud.simulators.carla.reader import Reader
from tmpud.simulators.carla.server import Server
from tmpud.simulators.carla.traffic import Traffic
from tmpud.simulators.cars import standing_at
from tmpud.simulators.conventions import DT

PATIENCE = 20.0  # [s] simulated, that the ego waits for room


class Drive:
    """A loaded map in which cars circulate, and later the ego among them."""

    def __init__(self, server: Server, seed: int, rules: dict[str, float]) -> None:
        rng = random.Random(f"carla/{seed}")  # noqa: S311
        self._server = server
        self._reader, self._lights = Reader(server.world), Lights(server.world)
        self._ego: Ego | None = None
        self._traffic = Traffic(server, rng, seed, rules)

    def fill(self, traffic: int) -> None:
        """Put the other cars on the road."""
        self._traffic.fill(traffic)
        self._snapshot = self._server.tick()

    def enter(self, pose: Pose) -> None:
        """Put the ego at a pose, as soon as there is room."""
        if self._ego:
            self._ego.leave()
            self._ego = None
        for _ in range(round(PATIENCE / DT)):
            if not self._standing(pose):
                break
            self.step()
        self._traffic.move(self._standing(pose), self._snapshot, pose[:2])
        self._ego = Ego(self._server, pose)
        for _ in range(SETTLING):
            self.step()

    def park(self, pose: Pose) -> None:
        """Put a car there that stands for ever."""
        self._traffic.park(pose)
        self.step()

    def _standing(self, pose: Pose) -> list[int]:
        """Return who stands where the ego is to appear."""
        ids, table = self._reader.read(self._snapshot, None)
        others = Vehicles.of_table(tuple(map(str, ids)), ("",) * len(ids), table)
        return [int(name) for name in standing_at(others, pose)]

    def step(self, acceleration: float = 0.0, steering: float = 0.0) -> None:
        """Command the ego, take one step, and put back on the road what vanished from it."""
        if self._ego:
            self._ego.command(acceleration, steering)
        self._snapshot = self._server.tick()
        if self._ego:
            self._ego.observe(self._snapshot)
        self._traffic.keep(self._snapshot, self._ego.place if self._ego else None)

    def seen(self) -> tuple[dict[str, Any], FloatArray]:
        """Return what there is now: the ego's row first where it is there, then the others' in the order of ids."""
        ids, table = self._reader.read(self._snapshot, self._ego.id if self._ego else None)
        words: dict[str, Any] = {"frame": self._snapshot.frame, "ids": ids, "lights": self._lights.changed()}
        if self._ego:
            words["contacts"] = self._ego.contacts(self._snapshot.frame)
        return words, table

    def end(self) -> int:
        """Leave the server as it was found; return how many of our actors are left. Each part is tried."""
        left: list[int] = []
        with contextlib.ExitStack() as last_to_first:
            last_to_first.callback(lambda: left.append(self._server.leave()))
            last_to_first.callback(self._traffic.end)
            if self._ego:
                last_to_first.callback(self._ego.stop_listening)
        return left[0]
