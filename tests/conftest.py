"""What the tests share: where maps that do not ship with the package may lie."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import settings

from tests.simulators import nets

settings.register_profile("untimed", deadline=None)  # a busy machine fails no test
settings.load_profile("untimed")

SHARED_MAPS = Path(__file__).resolve().parents[2] / "shared" / "maps"


@pytest.fixture(params=["Town01", "Town05"])
def carla_net(request: pytest.FixtureRequest) -> Path:
    """Return the net of a CARLA town, from the folder beside the repository."""
    path = SHARED_MAPS / f"{request.param}.net.xml"
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    return path


@pytest.fixture(scope="session")
def blocks_net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the net of two blocks with two lanes each way, before a left turn."""
    return nets.two_blocks(tmp_path_factory.mktemp("nets"))


@pytest.fixture(scope="session")
def spur_net(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the net of a ring of roads, from which one leads into a dead end."""
    return nets.spur(tmp_path_factory.mktemp("nets"))


@pytest.fixture(scope="session")
def blocks_xodr(blocks_net: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the two blocks as OpenDRIVE; skips where CARLA's client is not installed."""
    pytest.importorskip("carla")
    from tests.carla_loopback.towns import as_opendrive

    return as_opendrive(blocks_net, tmp_path_factory.mktemp("xodr"))


@pytest.fixture(scope="session")
def millbrook_xodr(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the shipped town as OpenDRIVE; skips where CARLA's client is not installed."""
    pytest.importorskip("carla")
    from tests.carla_loopback.towns import as_opendrive
    from tmpud.roads.loading import map_file

    return as_opendrive(map_file("millbrook"), tmp_path_factory.mktemp("xodr"))
