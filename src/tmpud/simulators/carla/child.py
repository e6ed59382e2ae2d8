"""The process that holds CARLA's client. Whatever becomes of the client or the server, only this process ends by it.

It is started by ``python -m tmpud.simulators.carla.child DESCRIPTOR`` and does what it is asked over a pipe, one thing
at a time. When the pipe's other end is gone it leaves the server as it found it.
"""

from __future__ import annotations

import contextlib
import signal
import sys
from multiprocessing.connection import Connection
from typing import Any

import carla

from tmpud.errors import SimulatorError
from tmpud.geometry import Pose
from tmpud.scene import FloatArray
from tmpud.simulators.carla.drive import Drive
from tmpud.simulators.carla.messages import receive, send
from tmpud.simulators.carla.server import Server
from tmpud.simulators.carla.turns import turn

LONGEST = 240  # [s] for one thing; whoever asked has given up long before, if he is still there

Answer = tuple[dict[str, Any], FloatArray | None]


class Child:
    """What can be asked of this process."""

    def __init__(self) -> None:
        self._server: Server | None = None
        self._drive: Drive | None = None

    def do(self, name: str, arguments: dict[str, Any]) -> Answer:
        """Do what is asked; RuntimeError (the client's) or SimulatorError where it cannot be done."""
        signal.alarm(LONGEST)  # ends this process, where the client hangs and nobody is left to do so
        try:
            answer: Answer = getattr(self, f"_{name}")(**arguments)
        finally:
            signal.alarm(0)
        return answer

    def _connect(self, host: str, port: int, patience: float) -> Answer:
        self._turn = turn(host, port)
        self._server = Server(carla.Client(host, port), patience)
        return {"version": self._server.version, "found": self._server.found}, None

    def _map(self, name: str) -> Answer:
        return {"xodr": self.server.map_text(name)}, None

    def _load(self, name: str, seed: int, traffic: int, rules: dict[str, float]) -> Answer:
        self.server.load(name)
        self._drive = Drive(self.server, seed, rules)
        self._drive.fill(traffic)
        return self._drive.seen()

    def _warm_up(self, steps: int) -> Answer:
        for _ in range(steps):
            self.drive.step()
        return self.drive.seen()

    def _enter(self, x: float, y: float, heading: float) -> Answer:
        self.drive.enter(Pose(x, y, heading))
        return self.drive.seen()

    def _step(self, acceleration: float, steering: float) -> Answer:
        self.drive.step(acceleration, steering)
        return self.drive.seen()

    def _park(self, x: float, y: float, heading: float) -> Answer:
        self.drive.park(Pose(x, y, heading))
        return self.drive.seen()

    def _look(self) -> Answer:
        return {"settings": self.server.settings(), "actors": self.server.left_behind()}, None

    def _sweep(self, settings: dict[str, Any]) -> Answer:
        """Remove what a process before this one left behind."""
        return {"left": self.server.sweep(settings)}, None

    def _close(self) -> Answer:
        drive, server = self._drive, self._server
        self._drive = self._server = None
        if drive:
            return {"left": drive.end()}, None
        return {"left": server.leave() if server else 0}, None

    @property
    def server(self) -> Server:
        if self._server is None:
            raise SimulatorError("not connected to a CARLA server")
        return self._server

    @property
    def drive(self) -> Drive:
        if self._drive is None:
            raise SimulatorError("no map is loaded")
        return self._drive


def serve(link: Connection) -> None:
    """Answer until asked to close, or until nobody asks any more."""
    child, wanted = Child(), True
    while wanted:
        try:
            name, arguments = (asked := receive(link).words)["do"], asked["with"]
        except (EOFError, OSError):
            with contextlib.suppress(RuntimeError):
                child.do("close", {})
            return
        wanted = name != "close"
        try:
            words, table = child.do(name, arguments)
        except (RuntimeError, OSError, SimulatorError) as error:
            words, table = {"error": " ".join(str(error).split())}, None
        with contextlib.suppress(OSError):
            send(link, words, table)


if __name__ == "__main__":
    serve(Connection(int(sys.argv[1])))
