"""A Traffic Manager that sleeps through a tick is woken; one that only waits for the server is not."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import msgpack
import pytest

from tests.carla_loopback.running import loopback
from tmpud.roads import load_map
from tmpud.scene import Control
from tmpud.simulators.carla import waking
from tmpud.simulators.carla.session import Address
from tmpud.simulators.carla.simulator import CarlaSimulator
from tmpud.simulators.carla.waking import Waker, wake

CALLS = [["set_synchronous_mode", [False]], ["set_synchronous_mode", [True]]]


class Manager:
    """Takes calls as the Traffic Manager's own server does."""

    def __init__(self) -> None:
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listening.getsockname()[1]
        self.heard: list[list[object]] = []
        self.woken = threading.Event()
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while True:
            link, _ = self._listening.accept()
            unpacker = msgpack.Unpacker()
            while data := link.recv(1 << 10):
                unpacker.feed(data)
                for _kind, number, name, arguments in unpacker:
                    self.heard.append([name, arguments])
                    link.sendall(msgpack.packb([1, number, None, None]))
            self.woken.set()


@pytest.fixture
def manager() -> Manager:
    return Manager()


@pytest.fixture
def waker(manager: Manager, monkeypatch: pytest.MonkeyPatch) -> Iterator[Waker]:
    monkeypatch.setattr(waking, "ASLEEP", 0.05)
    monkeypatch.setattr(waking, "LOOKS", 0.01)
    watching = Waker(manager.port)
    yield watching
    watching.end()


def test_a_manager_is_told_to_leave_synchronous_mode_and_to_return(manager: Manager) -> None:
    wake(manager.port)
    assert manager.woken.wait(10.0)
    assert manager.heard == CALLS


def test_who_sleeps_through_a_tick_is_woken(manager: Manager, waker: Waker) -> None:
    with waker.watching(lambda: True):
        assert manager.woken.wait(10.0)
    assert manager.heard[:2] == CALLS


def test_while_the_server_has_not_taken_the_step_and_between_ticks_nobody_is_woken(
    manager: Manager, waker: Waker
) -> None:
    looked = threading.Event()

    def not_yet() -> bool:
        looked.set()
        return False

    with waker.watching(not_yet):
        assert looked.wait(10.0)
    time.sleep(0.1)
    assert manager.heard == []


def test_a_manager_that_is_gone_ends_no_watch(waker: Waker, monkeypatch: pytest.MonkeyPatch) -> None:
    tried = threading.Semaphore(0)

    def refused(_port: int) -> None:
        tried.release()
        raise ConnectionRefusedError

    monkeypatch.setattr(waking, "wake", refused)
    with waker.watching(lambda: True):
        assert tried.acquire(timeout=10.0)
        assert tried.acquire(timeout=10.0)


def test_the_clients_own_manager_takes_the_call_and_drives_on(blocks_net: Path, blocks_xodr: Path) -> None:
    with (
        loopback(blocks_xodr) as server,
        CarlaSimulator(load_map(blocks_net), traffic=3, seed=1, server=Address(port=server.port), warm_up=0.0) as town,
    ):
        town.reset("a_0", 30.0)
        (manager,) = server.report()["managers"]
        wake(manager)
        before = town.everyone()
        for _ in range(40):
            town.step(Control(0.0, 0.0))
        assert (before.x != town.everyone().x).any()
