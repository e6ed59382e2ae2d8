import math
from itertools import combinations
from pathlib import Path

import pytest

from tmpud.geometry import Pose
from tmpud.roads import load_map
from tmpud.scene import Body, Control, Vehicles
from tmpud.simulators import cars as cars_module
from tmpud.simulators.cars import standing_at
from tmpud.simulators.conventions import DT, SENSING_RANGE
from tmpud.simulators.sumo import SumoSimulator
from tmpud.simulators.traffic import TrafficRules


def test_the_ego_takes_the_place_of_a_car_in_the_flow_and_another_starts_elsewhere(blocks_net: Path) -> None:
    with SumoSimulator(load_map(blocks_net), traffic=25, seed=1, warm_up=20.0) as town:
        before = set(town.everyone().ids)
        ego = town.reset("a_0", 20.0).ego
        assert 0.0 < ego.speed <= 20 / 3.6
        cars = town.everyone()
        (gone,) = before - set(cars.ids)
        ahead = [i for i, lane in enumerate(cars.lanes) if lane == "a_0"]
        assert all(abs(cars.x[i] - ego.pose.x) > 4.7 for i in ahead)
        for _ in range(400):  # it may have to wait until there is room for it
            town.step(Control(-3.0, 0.0))
        assert set(town.everyone().ids) == before - {gone} | {"car25"}


def test_a_car_stuck_out_of_sight_starts_anew_elsewhere_and_one_in_sight_stays(
    blocks_net: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cars_module, "STUCK", 20.0)
    with SumoSimulator(load_map(blocks_net), traffic=6, seed=1, warm_up=20.0) as town:
        ego = town.reset("a_0", 20.0).ego.pose
        cars = town.everyone()
        seen = {
            name: math.hypot(x - ego.x, y - ego.y) < SENSING_RANGE
            for name, x, y in zip(cars.ids, cars.x, cars.y, strict=True)
        }
        for name in cars.ids:
            town._sumo.vehicle.setSpeed(name, 0.0)
        for _ in range(round(26.0 / DT)):
            town.step(Control(-3.0, 0.0))
        stayed = set(town.everyone().ids) & set(cars.ids)
        assert len(town.everyone()) == len(cars)
    assert 0 < sum(seen.values()) < len(seen)
    assert stayed == {name for name, is_seen in seen.items() if is_seen}


@pytest.mark.parametrize("gap", [2.5, 6.0])
def test_cars_keep_the_minimum_gap_in_a_queue(blocks_net: Path, gap: float) -> None:
    rules = TrafficRules(min_gap=gap)
    with SumoSimulator(load_map(blocks_net), traffic=70, seed=1, warm_up=60.0, rules=rules) as town:
        cars = town.everyone()
    slow = [i for i, lane in enumerate(cars.lanes) if cars.speed[i] < 1.0 and not lane.startswith(":")]
    pairs = [(i, j) for i, j in combinations(slow, 2) if cars.lanes[i] == cars.lanes[j]]
    gaps = [math.dist((cars.x[i], cars.y[i]), (cars.x[j], cars.y[j])) - cars.length[i] for i, j in pairs]
    assert gap - 0.3 < min(gaps) < gap + 3.0


@pytest.mark.parametrize(
    ("x", "y", "is_there"), [(10.0, 0.0, True), (-10.0, 1.0, True), (-20.0, 0.0, False), (0.0, 3.2, False)]
)
def test_room_for_a_car_is_wanted_before_and_behind_and_not_on_the_next_lane(
    x: float, y: float, is_there: bool
) -> None:
    others = Vehicles(("car",), ("lane",), [Body(x, y, 0.0, 0.0, 5.0, 0.0, 0.0, 5.0, 1.8)])
    assert standing_at(others, Pose(0.0, 0.0, 0.0)) == (["car"] if is_there else [])
