from __future__ import annotations

from pathlib import Path

import pytest

from tests.roads.opendrive.crossroads import crossroads
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive.reading import has_carla, read_opendrive


@pytest.fixture(scope="session")
def crossroads_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("opendrive") / "crossroads.xodr"
    path.write_text(crossroads())
    return path


@pytest.fixture(scope="session")
def town(crossroads_file: Path) -> RoadNetwork:
    """Return the crossroads as CARLA's parser understands them."""
    if not has_carla():
        pytest.skip("CARLA's client is not installed")
    return read_opendrive(crossroads_file)
