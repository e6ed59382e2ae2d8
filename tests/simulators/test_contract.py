"""What every Simulator keeps to, whatever town is behind it."""

import math
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

from tmpud.errors import InvalidStateError, SimulatorError
from tmpud.protocols import Simulator
from tmpud.roads import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control, Scene
from tmpud.simulators.conventions import DT, SENSING_RANGE
from tmpud.simulators.sumo import SumoSimulator

Start = Callable[..., Simulator]
CARS = 12
COAST = Control(0.0, 0.0)


@pytest.fixture
def blocks(blocks_net: Path) -> RoadNetwork:
    return load_map(blocks_net)


@pytest.fixture(params=["sumo", "carla"])
def start(request: pytest.FixtureRequest, blocks: RoadNetwork) -> Iterator[Start]:
    """Return what starts a simulator, each on a fresh server where it needs one; all are closed at the end."""
    with ExitStack() as stack:

        def in_sumo(traffic: int = CARS, seed: int = 1) -> Simulator:
            return stack.enter_context(SumoSimulator(blocks, traffic=traffic, seed=seed, warm_up=2.0))

        def in_carla(traffic: int = CARS, seed: int = 1) -> Simulator:
            from tests.carla_loopback.running import loopback
            from tmpud.simulators.carla.session import Address
            from tmpud.simulators.carla.simulator import CarlaSimulator

            server = Address(port=stack.enter_context(loopback(xodr)).port)
            return stack.enter_context(CarlaSimulator(blocks, traffic=traffic, seed=seed, server=server, warm_up=2.0))

        if request.param == "carla":
            xodr = request.getfixturevalue("blocks_xodr")
        yield in_sumo if request.param == "sumo" else in_carla


def test_the_ego_appears_on_its_lane_and_the_clock_goes_by_whole_steps(start: Start, blocks: RoadNetwork) -> None:
    town = start()
    before = town.reset("a_1", 30.0)
    at = blocks.lanes["a_1"].centre.pose_at(30.0)
    assert math.dist(before.ego.pose[:2], at[:2]) < 0.3
    assert before.ego.pose.heading == pytest.approx(at.heading, abs=0.02)
    assert (before.ego.id, before.ego.lane) == ("ego", "a_1")
    for i in range(1, 6):
        assert town.step(COAST).time == pytest.approx(before.time + i * DT)
    assert town.versions


def test_it_speeds_up_and_brakes_as_it_is_told(start: Start) -> None:
    town = start(traffic=0)
    speed = town.reset("a_0", 20.0).ego.speed
    scene = _after(town, Control(1.5, 0.0), 40)
    assert scene.ego.speed - speed == pytest.approx(3.0, abs=0.5)
    for _ in range(100):
        scene = town.step(Control(-2.0 if scene.ego.speed > 0.1 else 0.0, 0.0))
    assert abs(scene.ego.speed) < 0.2


def test_positive_steering_turns_to_the_left(start: Start) -> None:
    town = start(traffic=0)
    town.reset("a_0", 20.0)
    before = _after(town, Control(1.0, 0.0), 40).ego
    after = _after(town, Control(0.0, 0.1), 20).ego
    turned = after.pose.heading - before.pose.heading
    driven = math.dist(before.pose[:2], after.pose[:2])
    assert turned == pytest.approx(driven * math.tan(0.1) / 2.8, rel=0.15)
    assert after.yaw_rate > 0.0
    assert after.pose.y > before.pose.y


def test_the_others_are_all_there_in_order_without_the_ego(start: Start, blocks: RoadNetwork) -> None:
    town = start()
    town.reset("a_0", 20.0)
    scene = _after(town, COAST, 10)
    everyone = town.everyone()
    assert len(everyone) == CARS
    assert list(everyone.ids) == sorted(set(everyone.ids))
    assert set(scene.others.ids) <= set(everyone.ids) - {"ego"}
    assert (np.hypot(scene.others.x - scene.ego.pose.x, scene.others.y - scene.ego.pose.y) < SENSING_RANGE + 5.0).all()
    known = blocks.lanes.keys() | blocks.internal.keys() | {""}
    assert set(everyone.lanes) <= known
    assert sum(lane == "" for lane in everyone.lanes) <= 1
    assert (np.abs(everyone.heading) <= math.pi).all()
    assert (everyone.length > 3.0).all()


def test_cars_are_on_the_lane_that_they_are_said_to_be_on(start: Start, blocks: RoadNetwork) -> None:
    town = start()
    town.reset("a_0", 20.0)
    for _ in range(5):
        _after(town, COAST, 10)
        cars = town.everyone()
        for lane, x, y in zip(cars.lanes, cars.x.tolist(), cars.y.tolist(), strict=True):
            if lane in blocks.lanes:
                assert abs(blocks.lanes[lane].centre.project(x, y)[1]) < 2.5


def test_what_cannot_be_driven_is_refused(start: Start) -> None:
    town = start(traffic=0)
    with pytest.raises(SimulatorError, match="before reset"):
        town.step(COAST)
    town.reset("a_0", 20.0)
    town.announce(["a_0", "b_0"])
    for bad in (Control(math.nan, 0.0), Control(99.0, 0.0), Control(0.0, 2.0)):
        with pytest.raises(InvalidStateError):
            town.step(bad)


def test_it_can_be_closed_twice(start: Start) -> None:
    town = start(traffic=1)
    town.close()
    town.close()


def test_the_same_seed_gives_the_same_traffic_and_another_one_another(start: Start) -> None:
    def rows(seed: int) -> list[tuple[float, ...]]:
        town = start(seed=seed)
        town.reset("a_0", 20.0)
        _after(town, COAST, 20)
        cars = town.everyone()
        town.close()
        return [*zip(cars.x.tolist(), cars.y.tolist(), cars.speed.tolist(), strict=True)]

    assert rows(1) == rows(1) != rows(2)


def _after(town: Simulator, control: Control, steps: int) -> Scene:
    for _ in range(steps):
        scene = town.step(control)
    return scene
