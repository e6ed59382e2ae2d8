"""Wakes the Traffic Manager where it sleeps through a tick.

In client 0.9.16 a tick tells the manager's thread to begin its step without holding the lock that the thread waits
with. If the notice comes in the moment before it waits, it is lost, and both wait for each other for ever. Switching
the manager out of synchronous mode repeats the notice; it is in that mode again before the thread asks.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from tmpud.simulators.carla.server import Server

LOOK = 0.5  # [s]
ASLEEP = 3.0  # [s] no step of the manager takes so long


class Watchdog:
    """Watches the ticks of a server from a thread of its own, until it is stopped."""

    def __init__(self, server: Server, manager: Any) -> None:
        self._server, self._manager = server, manager
        self.woken = 0
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._over.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._over.wait(LOOK):
            if self.look(time.monotonic()):
                self._over.wait(ASLEEP)

    def look(self, now: float) -> bool:
        """Wake the manager if the server has answered a tick that does not end; whether it was so."""
        tick = self._server.ticking
        if tick is None or now - tick.since < ASLEEP or self._server.world.get_snapshot().frame == tick.before:
            return False
        self._manager.set_synchronous_mode(False)
        self._manager.set_synchronous_mode(True)
        self.woken += 1
        return True
