"""The loopback server itself: remote calls on one port, streams on the next, a tick of its own where nobody cues."""

from __future__ import annotations

import asyncio
import contextlib
import os
import struct
import sys
import time
from collections import Counter
from typing import Any

import msgpack

from tests.carla_loopback import wire
from tests.carla_loopback.calls import Calls
from tests.carla_loopback.town import FREE_DT, SYNC, Town

NONSENSE = ["nonsense"]
ASKED_BY_TRAFFIC_MANAGER = {"get_vehicle_light_states", "get_weather_parameters"}


class Server:
    """Serves one town."""

    def __init__(self, town: Town) -> None:
        self.town = town
        self.journal: Counter[str] = Counter()
        self.order: list[str] = []  # of the calls, ticks and controls apart
        self._subscribers: dict[int, set[asyncio.StreamWriter]] = {}
        self._late: list[tuple[int, int, bytes]] = []  # collisions still to be told: frame, stream, payload

    async def run(self) -> None:
        """Serve for ever; the first line printed is the port."""
        rpc, streams = await self._listen()
        port = rpc.sockets[0].getsockname()[1]
        self._calls = Calls(self.town, port + 1, self.tick)
        sys.stdout.write(f"{port}\n")
        sys.stdout.flush()
        async with rpc, streams:
            while True:
                await asyncio.sleep(FREE_DT)
                if not self.town.settings[SYNC]:
                    self.tick()

    async def _listen(self) -> tuple[asyncio.Server, asyncio.Server]:
        """Take two ports that follow each other."""
        while True:
            rpc = await asyncio.start_server(self._serve_calls, "127.0.0.1", 0)
            port = rpc.sockets[0].getsockname()[1]
            with contextlib.suppress(OSError):
                return rpc, await asyncio.start_server(self._serve_stream, "127.0.0.1", port + 1)
            rpc.close()

    async def _serve_stream(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(asyncio.IncompleteReadError, ConnectionError):
            (stream,) = struct.unpack("<I", await reader.readexactly(4))
            self._subscribers.setdefault(stream, set()).add(writer)
            await reader.read()
        for listeners in self._subscribers.values():
            listeners.discard(writer)
        writer.close()

    async def _serve_calls(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        unpacker = msgpack.Unpacker(raw=False, unicode_errors="surrogateescape")
        with contextlib.suppress(ConnectionError):
            while data := await reader.read(1 << 16):
                unpacker.feed(data)
                for _, number, name, (_meta, *arguments) in unpacker:
                    reply = self._reply(name, arguments)
                    writer.write(msgpack.packb([1, number, None, reply]))
                await writer.drain()
        writer.close()

    def _reply(self, name: str, arguments: list[Any]) -> Any:
        if name == "loopback_report":
            managers = sorted(self._calls.traffic_managers)
            return self.town.report() | {"journal": dict(self.journal), "order": self.order, "managers": managers}
        if name == "loopback_arm":
            for fault, value in arguments[0].items():
                setattr(self.town.faults, fault, value + self.town.frame if fault.endswith("_at") else value)
            return True
        if name == "loopback_park":
            return self.town.park(*arguments)
        self.journal[name] += 1
        if self.journal[name] < 3 or name.startswith(("set_", "spawn", "destroy", "load")):
            self.order.append(name)
        faults = self.town.faults
        if faults.nonsense_at and self.town.frame >= faults.nonsense_at and name in ASKED_BY_TRAFFIC_MANAGER:
            return NONSENSE
        return self._calls.answer(name, arguments)

    def tick(self) -> None:
        """Take one step and tell all who listen."""
        town = self.town
        town.tick()
        if town.frame == town.faults.die_at:
            os._exit(1)
        if town.frame == town.faults.freeze_at:
            time.sleep(3600)
        bodies = list(town.bodies.values())
        self._send(wire.WORLD_STREAM, wire.world_state(town.frame, town.episode, town.time, town.dt, bodies))
        for sensor, owner, other in town.collisions:
            header = wire.collision_header(town.frame, town.time, sensor)
            told = [wire.actor(owner, 0), wire.actor(other, 0), [0.0, 0.0, 0.0]]
            event = (town.frame + town.faults.collision_delay, sensor.id, header + msgpack.packb(told))
            self._late += [event] * town.faults.collision_copies
        for _, stream, payload in [event for event in self._late if event[0] <= town.frame]:
            self._send(stream, payload)
        self._late = [event for event in self._late if event[0] > town.frame]

    def _send(self, stream: int, payload: bytes) -> None:
        for writer in self._subscribers.get(stream, ()):
            writer.write(struct.pack("<I", len(payload)) + payload)
