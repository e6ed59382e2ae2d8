from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("carla")

from tmpud.simulators.carla.server import Ticking
from tmpud.simulators.carla.watchdog import ASLEEP, Watchdog


class Manager:
    def __init__(self) -> None:
        self.modes: list[bool] = []

    def set_synchronous_mode(self, mode: bool) -> None:
        self.modes.append(mode)


def looked(ticking: Ticking | None, frame: int) -> list[bool]:
    """Return what the manager was told after one look at time 100, where the server shows a frame."""
    manager = Manager()
    server: Any = SimpleNamespace(
        ticking=ticking, world=SimpleNamespace(get_snapshot=lambda: SimpleNamespace(frame=frame))
    )
    dog = Watchdog(server, manager)
    dog.stop()
    manager.modes.clear()
    dog.look(100.0)
    return manager.modes


def test_a_manager_that_sleeps_though_the_server_has_ticked_is_woken() -> None:
    assert looked(Ticking(100.0 - 2 * ASLEEP, 7), frame=8) == [False, True]


@pytest.mark.parametrize(
    ("ticking", "frame"),
    [(None, 8), (Ticking(100.0 - ASLEEP / 2, 7), 8), (Ticking(100.0 - 2 * ASLEEP, 7), 7)],
    ids=["no tick", "a short tick", "the server has not ticked"],
)
def test_otherwise_it_is_left_alone(ticking: Ticking | None, frame: int) -> None:
    assert looked(ticking, frame) == []
