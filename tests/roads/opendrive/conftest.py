"""Maps in OpenDRIVE: the tests' own, and CARLA's towns where they lie beside the repository."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.conftest import SHARED_MAPS
from tests.roads.opendrive.crossroads import crossroads
from tests.roads.opendrive.oracle import Facts, facts
from tmpud.roads.network import RoadNetwork
from tmpud.roads.opendrive.reading import has_carla, read_opendrive

TOWNS = sorted({"Town01", *(path.stem for path in SHARED_MAPS.glob("*.xodr"))})


class Case(NamedTuple):
    """A map as we read it, and what CARLA's client says of it."""

    network: RoadNetwork
    oracle: Facts


@pytest.fixture(scope="session")
def crossroads_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("opendrive") / "crossroads.xodr"
    path.write_text(crossroads())
    return path


@pytest.fixture(scope="session")
def town(crossroads_file: Path) -> RoadNetwork:
    """Return the crossroads as CARLA's parser understands them."""
    return _read(crossroads_file)


@pytest.fixture(params=["crossroads", *TOWNS])
def case(request: pytest.FixtureRequest, crossroads_file: Path) -> Case:
    file = crossroads_file if request.param == "crossroads" else SHARED_MAPS / f"{request.param}.xodr"
    if not file.is_file():
        pytest.skip(f"{file.name} is not there")
    return Case(_read(file), facts(file))


@cache
def _read(file: Path) -> RoadNetwork:
    if not has_carla():
        pytest.skip("CARLA's client is not installed")
    return read_opendrive(file)
