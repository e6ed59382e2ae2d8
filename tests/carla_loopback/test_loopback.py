import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.carla_loopback.running import Loopback, loopback

ERRAND = """
import json, sys, carla
client = carla.Client("127.0.0.1", int(sys.argv[1]))
client.set_timeout(10.0)
world = client.get_world()
settings = world.get_settings()
settings.synchronous_mode, settings.fixed_delta_seconds = True, 0.05
world.apply_settings(settings)
traffic = client.get_trafficmanager(int(sys.argv[2]))
traffic.set_synchronous_mode(True)
traffic.set_random_device_seed(1)
points, model = world.get_map().get_spawn_points(), world.get_blueprint_library().find("vehicle.tesla.model3")
spawn, drive, anyone = carla.command.SpawnActor, carla.command.SetAutopilot, carla.command.FutureActor
every = len(points) // 120
told = client.apply_batch_sync(
    [spawn(model, point).then(drive(anyone, True, int(sys.argv[2]))) for point in points[: 120 * every : every]], True
)
frames = [world.tick() for _ in range(100)]
cars = [actor for actor in world.get_snapshot() if actor.id in {reply.actor_id for reply in told}]
town = world.get_map()
off = [car.get_transform().location.distance(
    town.get_waypoint(car.get_transform().location).transform.location) for car in cars]
print(json.dumps({
    "town": town.name, "told": sum(not reply.error for reply in told), "cars": len(cars), "frames": frames,
    "lights": len(world.get_actors().filter("traffic.traffic_light")),
    "driving": sum(car.get_velocity().length() > 1.0 for car in cars), "off": max(off),
}))
client.apply_batch_sync([carla.command.DestroyActor(reply.actor_id) for reply in told], True)
traffic.set_synchronous_mode(False)
traffic.shut_down()
"""


@pytest.fixture
def drive(millbrook_xodr: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the real client says of a drive, and what the server says afterwards."""
    with loopback(millbrook_xodr) as server:
        command = [sys.executable, "-c", ERRAND, str(server.port), str(free_port())]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.splitlines()[-1]), server.report()


def free_port() -> int:
    import socket

    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
        return port


@pytest.mark.flaky(reruns=1, only_rerun="TimeoutExpired")  # the client alone, which nobody wakes, hangs at times
def test_the_real_client_and_its_traffic_manager_drive_120_cars(drive: tuple[dict[str, Any], dict[str, Any]]) -> None:
    seen, told = drive
    assert (seen["town"], seen["told"], seen["cars"]) == ("millbrook", 120, 120)
    assert seen["frames"] == list(range(seen["frames"][0], seen["frames"][0] + 100))
    assert seen["lights"] > 50
    assert seen["driving"] > 30
    assert seen["off"] < 3.0
    assert told["journal"]["apply_batch"] > 100
    assert "vehicle" not in told["actors"]


def test_a_fault_is_armed_while_the_server_runs(millbrook_xodr: Path) -> None:
    with loopback(millbrook_xodr) as server:
        server.arm(die_at=3)
        assert server.process.wait(timeout=10) == 1


def test_an_unknown_call_is_answered_by_its_name(millbrook_xodr: Path) -> None:
    with loopback(millbrook_xodr) as server:
        assert "does not know fly" in str(_asked(server, "fly"))


def _asked(server: Loopback, name: str) -> object:
    return server._ask(name)
