"""Wakes the Traffic Manager where it sleeps through a tick.

In client 0.9.16 a tick tells the Traffic Manager's thread to begin, and that thread tells the tick that it is done,
without the lock under which either looks whether it may go on: a notice that falls between looking and sleeping is
lost. The tick then waits for ever, and holds a lock without which nothing can be asked of the Traffic Manager through
the client. Its own server needs no such lock: told to leave synchronous mode, it gives the notice once more.
"""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable, Iterator

ASLEEP = 4.0  # [s] after which a tick that the server has taken is not just slow
LOOKS = 0.5  # [s] between two looks
ANSWERED = 2.0  # [s] in which the Traffic Manager's server answers

Tick = tuple[float, Callable[[], bool]]  # when it began [s], and whether the server has taken it


class Waker:
    """Looks after the ticks from a thread of its own, until it is ended."""

    def __init__(self, port: int) -> None:
        """``port`` is that of the Traffic Manager."""
        self._port = port
        self._tick: Tick | None = None
        self._ended = threading.Event()
        threading.Thread(target=self._look, daemon=True).start()

    @contextlib.contextmanager
    def watching(self, taken: Callable[[], bool]) -> Iterator[None]:
        """Look after a tick, which is the block; ``taken`` says whether the server has done its part."""
        self._tick = time.monotonic(), taken
        try:
            yield
        finally:
            self._tick = None

    def end(self) -> None:
        self._ended.set()

    def _look(self) -> None:
        woken = 0.0
        while not self._ended.wait(LOOKS):
            if (tick := self._tick) and time.monotonic() - max(tick[0], woken) > ASLEEP and tick[1]():
                woken = time.monotonic()
                with contextlib.suppress(OSError):
                    wake(self._port)


def wake(port: int) -> None:
    """Have a Traffic Manager leave synchronous mode and return to it; OSError where it does not answer."""
    with socket.create_connection(("127.0.0.1", port), ANSWERED) as link:
        for number, synchronous in enumerate((False, True)):
            link.sendall(_call(number, synchronous))
            link.recv(64)


def _call(number: int, synchronous: bool) -> bytes:
    """Return [0, number, "set_synchronous_mode", [synchronous]] as MessagePack."""
    return b"\x94\x00%c\xb4set_synchronous_mode\x91%c" % (number, 0xC2 + synchronous)
