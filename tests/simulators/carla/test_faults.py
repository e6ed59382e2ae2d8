"""What becomes of a drive where server, client or Traffic Manager fail, and of the server afterwards."""

import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.carla_loopback.running import Loopback, loopback
from tests.carla_loopback.town import default_settings
from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.roads import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control
from tmpud.simulators.carla.messages import Message
from tmpud.simulators.carla.session import Address, Session
from tmpud.simulators.carla.simulator import CarlaSimulator
from tmpud.simulators.carla.turns import turn

COAST = Control(0.0, 0.0)
CARS = 4
Start = Callable[[], CarlaSimulator]


@pytest.fixture
def blocks(blocks_net: Path) -> RoadNetwork:
    return load_map(blocks_net)


@pytest.fixture
def server(blocks_xodr: Path) -> Iterator[Loopback]:
    with loopback(blocks_xodr) as running:
        yield running


@pytest.fixture
def start(blocks: RoadNetwork, server: Loopback) -> Iterator[Start]:
    """Return what starts a drive with the ego on the road; it is closed at the end."""
    running: list[CarlaSimulator] = []

    def begin() -> CarlaSimulator:
        at = Address(port=server.port, patience=2.0)
        running.append(CarlaSimulator(blocks, traffic=CARS, seed=1, server=at, warm_up=0.0))
        running[-1].reset("a_0", 30.0)
        return running[-1]

    yield begin
    for drive in running:
        drive.close()


def drive_on(drive: CarlaSimulator, steps: int = 30) -> None:
    for _ in range(steps):
        drive.step(COAST)


def assert_left_as_found(server: Loopback) -> None:
    report = server.report()
    assert report["actors"].get("vehicle", 0) + report["actors"].get("sensor", 0) == 0
    assert report["settings"] == default_settings()


def assert_drives(drive: CarlaSimulator) -> None:
    drive_on(drive, 3)
    assert len(drive.everyone()) == CARS


def test_a_server_that_dies_is_an_error_with_its_reason(start: Start, server: Loopback) -> None:
    drive = start()
    server.arm(die_at=5)
    with pytest.raises(SimulatorError, match=f"CARLA at 127.0.0.1:{server.port}"):
        drive_on(drive)
    drive.close()


@pytest.mark.parametrize("crashes", [1, 2])
def test_a_client_that_crashes_over_a_map_is_followed_by_one_more(
    start: Start, server: Loopback, monkeypatch: pytest.MonkeyPatch, crashes: int
) -> None:
    ask, loads = Session.ask, list[int]()

    def fatal(session: Session, name: str, limit: float, /, **arguments: Any) -> Message:
        if name == "load":
            loads.append(session.process)
            if len(loads) <= crashes:
                os.kill(session.process, signal.SIGSEGV)
        return ask(session, name, limit, **arguments)

    monkeypatch.setattr(Session, "ask", fatal)
    if crashes == 1:
        assert_drives(start())
    else:
        with pytest.raises(SimulatorError, match="the client ended with -11 when asked to 'load'"):
            start()
    assert len(set(loads)) == 2
    assert server.report()["actors"].get("vehicle", 0) == (CARS + 1 if crashes == 1 else 0)


def test_a_server_that_freezes_is_an_error_of_its_own(start: Start, server: Loopback) -> None:
    drive = start()
    server.arm(freeze_at=5)
    with pytest.raises(SimulatorHangError):
        drive_on(drive)


def test_after_an_abort_of_the_traffic_manager_the_next_drive_works(start: Start, server: Loopback) -> None:
    drive = start()
    server.arm(nonsense_at=5)
    with pytest.raises(SimulatorError, match="ended with -6"):
        drive_on(drive)
    server.arm(nonsense_at=10**9)
    assert_left_as_found(server)
    assert_drives(start())


def test_after_a_killed_client_nothing_is_left_and_the_next_drive_works(start: Start, server: Loopback) -> None:
    drive = start()
    os.kill(drive.process, signal.SIGKILL)
    with pytest.raises(SimulatorError, match="ended with -9"):
        drive.step(COAST)
    with pytest.raises(SimulatorError, match="the session is over"):
        drive.step(COAST)
    assert_left_as_found(server)
    assert_drives(start())


def test_a_client_killed_between_two_steps_is_tidied_after_when_the_drive_is_closed(
    start: Start, server: Loopback
) -> None:
    drive = start()
    os.kill(drive.process, signal.SIGKILL)
    drive.close()
    assert_left_as_found(server)


ABANDONED = """
import os, signal, sys
from tmpud.roads import load_map
from tmpud.simulators.carla.session import Address
from tmpud.simulators.carla.simulator import CarlaSimulator
drive = CarlaSimulator(load_map(sys.argv[1]), traffic=4, seed=1, server=Address(port=int(sys.argv[2])), warm_up=0.0)
drive.reset("a_0", 30.0)
if "both" in sys.argv:
    os.kill(drive.process, signal.SIGKILL)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_client_whose_parent_is_killed_tidies_up(blocks_net: Path, server: Loopback) -> None:
    command = [sys.executable, "-c", ABANDONED, str(blocks_net), str(server.port)]
    assert subprocess.run(command, check=False).returncode == -signal.SIGKILL
    for _ in range(100):
        if server.report()["settings"] == default_settings():
            break
        time.sleep(0.1)
    assert_left_as_found(server)


def test_what_two_killed_processes_left_is_gone_when_the_next_drive_is(
    blocks_net: Path, server: Loopback, start: Start
) -> None:
    command = [sys.executable, "-c", ABANDONED, str(blocks_net), str(server.port), "both"]
    subprocess.run(command, check=False)
    assert server.report()["actors"]["vehicle"] == CARS + 1
    drive = start()
    assert_drives(drive)
    drive.close()
    assert_left_as_found(server)


def test_while_one_drive_uses_a_server_another_one_is_refused(start: Start, server: Loopback) -> None:
    drive = start()
    with pytest.raises(SimulatorError, match=f"in use by tmpud's process {drive.process}:"):
        turn("127.0.0.1", server.port, 0.1)
    drive.close()
    turn("127.0.0.1", server.port, 0.1).close()


HUNG = """
import time
from tmpud.simulators.carla import child
class Hung(child.Child):
    def _hang(self):
        time.sleep(60.0)
child.LONGEST = 1
Hung().do("hang", {})
"""


def test_a_client_that_hangs_with_nobody_left_to_see_it_ends() -> None:
    command = [sys.executable, "-c", HUNG]
    assert subprocess.run(command, check=False).returncode == -signal.SIGALRM


@pytest.mark.parametrize("version", ["0.9.15", "0.10.0"])
def test_another_version_is_refused_with_both_named(blocks: RoadNetwork, blocks_xodr: Path, version: str) -> None:
    with loopback(blocks_xodr, version=version) as server:
        with pytest.raises(SimulatorError, match=rf"{version}.*0\.9\.16"):
            CarlaSimulator(blocks, traffic=0, seed=1, server=Address(port=server.port))
        assert "set_episode_settings" not in server.report()["journal"]


def test_refused_cars_are_put_elsewhere(start: Start, server: Loopback) -> None:
    server.arm(refused_spawns=3)
    assert_drives(start())


def test_a_server_that_refuses_all_cars_is_an_error(start: Start, server: Loopback) -> None:
    server.arm(refused_spawns=10**6)
    with pytest.raises(SimulatorError, match=f"0 of {CARS} vehicles"):
        start()
    assert_left_as_found(server)


def test_a_vanished_car_comes_back_and_a_vanished_ego_is_an_error(start: Start, server: Loopback) -> None:
    drive = start()
    server.arm(vanish_at=2, vanish=2, vanish_first=True)
    before = set(drive.everyone().ids)
    drive_on(drive, 5)
    after = set(drive.everyone().ids)
    assert len(after) == CARS
    assert len(after - before) == 2
    server.arm(vanish_at=2, vanish=CARS + 1)
    with pytest.raises(SimulatorError, match="the ego vanished"):
        drive_on(drive, 5)
    drive.close()
    assert_left_as_found(server)


def test_a_contact_told_often_and_late_is_one_contact(start: Start, server: Loopback, blocks: RoadNetwork) -> None:
    drive = start()
    x, y, heading = blocks.lanes["a_0"].centre.pose_at(40.0)
    server.park(x, -y, -math.degrees(heading))
    server.arm(collision_copies=3, collision_delay=4)
    for _ in range(100):
        scene = drive.step(Control(2.0, 0.0))
    assert len(drive.contacts) == 1
    when, other = drive.contacts[0]
    assert other in scene.others.ids
    assert 0.0 < when < scene.time
    drive.close()
    assert server.report()["actors"]["vehicle"] == 1  # the one that is none of ours


def test_no_server_and_no_client_are_one_line_each(blocks: RoadNetwork, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(SimulatorError, match=r"no CARLA server at 127\.0\.0\.1:1 "):
        CarlaSimulator(blocks, traffic=0, seed=1, server=Address(port=1))
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(SimulatorError, match=r"pip install 'tmpud\[carla\]'"):
        CarlaSimulator(blocks, traffic=0, seed=1)
