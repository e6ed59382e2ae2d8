"""The supervised process that holds CARLA's client: started, asked, and given up when it does not answer."""

from __future__ import annotations

import contextlib
import importlib.util
import socket
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from multiprocessing import Pipe
from typing import Any

from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.simulators.carla.messages import Message, receive, send

REACHED = 2.0  # [s] in which a server takes a connection
STARTED = 20.0  # [s] in which the process is up
MARGIN = 5.0  # [s] beyond its own patience that the process has for an answer
LOADED = 180.0  # [s] in which a map is loaded and traffic put on it
CLOSED = 20.0  # [s] in which the server is left as it was found
SAID = 300  # characters of the process's last words that go into an error


@dataclass(frozen=True, slots=True, kw_only=True)
class Address:
    """Where a CARLA server is."""

    host: str = "127.0.0.1"
    port: int = 2000
    patience: float = 10.0  # [s] in which it answers a call

    @classmethod
    def named(cls, name: str) -> Address:
        """Return the server that ``str`` named."""
        host, _, port = name.rpartition(":")
        return cls(host=host, port=int(port))

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"


class Session:
    """CARLA's client in a process of its own; however that ends, here it is a SimulatorError."""

    def __init__(self, server: Address) -> None:
        """Connect; SimulatorError without client or server, or where their versions differ."""
        self._server = server
        self._connect()

    def _connect(self) -> None:
        server = self._server
        _look_for(server)
        self._found: dict[str, Any] | None = None  # the settings to leave behind, once they may have been changed
        self._start()
        try:
            told = self.ask("connect", STARTED, host=server.host, port=server.port, patience=server.patience)
        except SimulatorError:
            self._end()
            raise
        self.version: str = told.words["version"]
        self._found = told.words["found"]

    def _start(self) -> None:
        self._crashed = False
        here, there = Pipe()
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  closed with the process
        command = [sys.executable, "-P", "-m", "tmpud.simulators.carla.child", str(there.fileno())]
        self._process = subprocess.Popen(  # noqa: S603
            command, pass_fds=[there.fileno()], stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log,
            start_new_session=True,
        )  # fmt: skip
        there.close()
        self._link = here

    @property
    def patience(self) -> float:
        """Return how long the server may take for a step [s]."""
        return self._server.patience

    @property
    def process(self) -> int:
        """Return the id of the process."""
        return self._process.pid

    def ask(self, name: str, limit: float, /, **arguments: Any) -> Message:
        """Return the answer; SimulatorError where the process refuses or ends, SimulatorHangError after ``limit`` s."""
        if self._log.closed:
            raise SimulatorError(f"CARLA at {self._server}: the session is over")
        try:
            send(self._link, {"do": name, "with": arguments})
            if not self._link.poll(limit):
                raise SimulatorHangError(f"CARLA at {self._server}: no answer to '{name}' within {limit:g} s")
            answer = receive(self._link)
        except (EOFError, OSError):
            raise self._died(name) from None
        except SimulatorHangError:
            self._end()
            raise
        if "error" in answer.words:
            raise self._refused(name, answer.words["error"])
        return answer

    def load(self, name: str, /, **arguments: Any) -> Message:
        """Ask for what loads a map. Where the client crashes, as 0.9.16 does now and then, another process is asked."""
        try:
            return self.ask(name, LOADED, **arguments)
        except SimulatorError:
            if not self._crashed:
                raise
        self._connect()
        return self.ask(name, LOADED, **arguments)

    def step(self, acceleration: float, steering: float) -> Message:
        """Take one step."""
        return self.ask("step", self.patience + MARGIN, acceleration=acceleration, steering=steering)

    def close(self) -> None:
        """Leave the server as it was found; a second call does nothing."""
        if self._process.poll() is None:
            with contextlib.suppress(SimulatorError):
                self.ask("close", CLOSED)
                self._process.wait(CLOSED)
        self._end()

    def _died(self, asked: str) -> SimulatorError:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(MARGIN)
        code, said = self._process.poll(), self._last_words()
        self._crashed = code is not None and code < 0  # by a signal
        self._end()
        if asked == "connect":
            return self._fault(f"whoever listens there is no CARLA server: the client ended with {code}: {said}")
        return self._fault(f"the client ended with {code} when asked to '{asked}': {said}")

    def _refused(self, asked: str, why: str) -> SimulatorError:
        return self._fault(f"'{asked}' failed: {why}")

    def _fault(self, said: str) -> SimulatorError:
        """Tell a server that takes too long from one that is gone; the client speaks of a time-out in both cases."""
        late = "time-out" in said and _listens(self._server) is None
        return (SimulatorHangError if late else SimulatorError)(f"CARLA at {self._server}: {said}")

    def _last_words(self) -> str:
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").split("\n")
        return " ".join(line.strip() for line in lines if line.strip() and not line.startswith("WARNING"))[-SAID:]

    def _end(self) -> None:
        """End the process; where it did not leave the server as it was, another one does."""
        self._link.close()
        if self._log.closed:
            return
        unclean = self._process.poll() != 0
        self._process.kill()
        self._process.wait()
        self._log.close()
        found, self._found = self._found, None
        if unclean and found:
            sweep(self._server, found)


def sweep(server: Address, found: dict[str, Any]) -> None:
    """Remove what a client that died left on a server, as far as the server still answers."""
    with contextlib.suppress(SimulatorError):
        broom = Session(Address(host=server.host, port=server.port, patience=REACHED))
        broom._found = None  # it is not swept after
        with contextlib.closing(broom):
            broom.ask("sweep", CLOSED, settings=found)


def _look_for(server: Address) -> None:
    """Raise SimulatorError in one line where the client is not installed or nobody listens."""
    if importlib.util.find_spec("carla") is None:
        raise SimulatorError("CARLA's client is not installed: pip install 'tmpud[carla]'")
    if reason := _listens(server):
        raise SimulatorError(f"no CARLA server at {server} ({reason}): start it, or name --host and --port")


def _listens(server: Address) -> str | None:
    """Return why nobody can be reached, None where somebody can."""
    try:
        socket.create_connection((server.host, server.port), REACHED).close()
    except OSError as error:
        return error.strerror or str(error)
    return None
