"""What goes between the two processes: one message of words (JSON), and a table of numbers where there is one."""

from __future__ import annotations

import json
from multiprocessing.connection import Connection
from typing import Any, NamedTuple

import numpy as np

from tmpud.scene import FloatArray

COLUMNS = 9  # x, y, z, heading, speed, yaw rate, acceleration, length, width: as in scene.Vehicles


class Message(NamedTuple):
    words: dict[str, Any]
    table: FloatArray  # (N, COLUMNS)


def send(link: Connection, words: dict[str, Any], table: FloatArray | None = None) -> None:
    """Send one message; OSError where nobody is at the other end."""
    link.send_bytes(json.dumps(words, allow_nan=False).encode())
    link.send_bytes(b"" if table is None else table.tobytes())


def receive(link: Connection) -> Message:
    """Return the next message; EOFError where the other end is gone."""
    words = json.loads(link.recv_bytes())
    return Message(words, np.frombuffer(link.recv_bytes(), dtype=np.float64).reshape(-1, COLUMNS))
