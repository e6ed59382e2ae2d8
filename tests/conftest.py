"""What the tests share: where maps that do not ship with the package may lie."""

from __future__ import annotations

from pathlib import Path

import pytest

SHARED_MAPS = Path(__file__).resolve().parents[2] / "shared" / "maps"


@pytest.fixture(params=["Town01", "Town05"])
def carla_net(request: pytest.FixtureRequest) -> Path:
    """Return the net of a CARLA town, from the folder beside the repository."""
    path = SHARED_MAPS / f"{request.param}.net.xml"
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    return path
