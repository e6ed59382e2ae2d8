"""``carla verify`` passes on a server that keeps to what is expected, and says of another what it does wrong."""

from pathlib import Path
from typing import Any

import pytest

from tests.carla_loopback.running import loopback
from tmpud.simulators.carla.session import Address
from tmpud.simulators.carla.verify import Check, verify


def tried(xodr: Path, net: Path, **faults: Any) -> dict[str, Check]:
    with loopback(xodr, **faults) as server:
        return {check.what: check for check in verify(Address(port=server.port), str(net), traffic=4, seed=1)}


def failed(checks: dict[str, Check]) -> set[str]:
    return {name for name, check in checks.items() if not check.passed}


def test_a_good_server_passes_in_everything(blocks_xodr: Path, blocks_net: Path) -> None:
    checks = tried(blocks_xodr, blocks_net)
    assert failed(checks) == set()
    assert "steer > 0 turns it 0.1" in checks["steers right"].found
    assert "rad to the right" in checks["steers right"].found
    assert {"versions", "settings", "steers left", "collision", "repeatable", "left as found"} <= checks.keys()


def test_mirrored_steering_and_actors_that_stay_are_seen(blocks_xodr: Path, blocks_net: Path) -> None:
    checks = tried(blocks_xodr, blocks_net, mirrored=True, keeps_actors=True)
    assert {"steers left", "steers right", "left as found"} <= failed(checks)
    assert {"versions", "settings", "speeds up", "brakes"}.isdisjoint(failed(checks))


@pytest.mark.parametrize("version", ["0.9.15"])
def test_another_version_is_all_that_is_said(blocks_xodr: Path, blocks_net: Path, version: str) -> None:
    checks = tried(blocks_xodr, blocks_net, version=version)
    assert list(checks) == ["versions"]
    assert version in checks["versions"].found
    assert not checks["versions"].passed
