from functools import cache
from pathlib import Path

import pytest

from tests.motion.turns import Driven, drive_every_turn
from tmpud.dynamics import EGO
from tmpud.roads import load_map, shipped_towns


@cache
def turns(map_: str) -> list[Driven]:
    return drive_every_turn(load_map(map_))


def check(driven: list[Driven]) -> None:
    assert len(driven) > 10
    for turn in driven:
        assert turn.rms < 0.3, turn
        assert turn.speed <= EGO.max_speed + 0.2, turn
        assert turn.lateral_acceleration <= EGO.max_lateral_acceleration, turn


@pytest.mark.parametrize("town", shipped_towns())
def test_every_turn_of_a_shipped_town_is_driven_well(town: str) -> None:
    check(turns(town))


def test_every_turn_of_a_carla_town_is_driven_well(carla_net: Path) -> None:
    check(turns(str(carla_net)))
