"""Starts the loopback server in a process of its own, for a test, and asks it what came to pass."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgpack

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True, slots=True)
class Loopback:
    """A running server, as a test sees it."""

    port: int
    process: subprocess.Popen[str]

    def report(self) -> dict[str, Any]:
        """Return frame, settings, actors and the journal of calls."""
        report: dict[str, Any] = self._ask("loopback_report")
        return report

    def arm(self, **faults: object) -> None:
        """Let something go wrong; frames count from now."""
        self._ask("loopback_arm", faults)

    def park(self, x: float, y: float, yaw: float) -> int:
        """Put a car on the road that is none of the client's; CARLA's coordinates."""
        actor: int = self._ask("loopback_park", x, y, yaw)
        return actor

    def _ask(self, name: str, *arguments: object) -> Any:
        with socket.create_connection(("127.0.0.1", self.port), 5.0) as connection:
            connection.sendall(msgpack.packb([0, 1, name, [[False], *arguments]]))
            unpacker = msgpack.Unpacker(strict_map_key=False)
            while data := connection.recv(1 << 16):
                unpacker.feed(data)
                for reply in unpacker:
                    return reply[3]
        raise ConnectionError("the loopback server closed the connection")


@contextmanager
def loopback(xodr: Path, **faults: object) -> Iterator[Loopback]:
    """Serve a map until the block ends."""
    command = [sys.executable, "-m", "tests.carla_loopback", str(xodr), "--faults", json.dumps(faults)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        try:
            assert process.stdout is not None
            yield Loopback(int(process.stdout.readline()), process)
        finally:
            process.kill()
