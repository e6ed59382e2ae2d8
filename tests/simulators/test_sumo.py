import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.simulators.crowded import CrowdedSumo, Neighbour
from tmpud.errors import InvalidStateError, SimulatorError
from tmpud.judging.boxes import box_of, overlapping
from tmpud.roads import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control, Scene
from tmpud.simulators import sumo
from tmpud.simulators.conventions import DT
from tmpud.simulators.sumo import SumoSimulator
from tmpud.simulators.traffic import Spot

Start = Callable[..., SumoSimulator]
COAST = Control(0.0, 0.0)


@pytest.fixture
def blocks(blocks_net: Path) -> RoadNetwork:
    return load_map(blocks_net)


@pytest.fixture
def start(blocks: RoadNetwork) -> Iterator[Start]:
    """Return what starts a simulation, which is closed at the end."""
    running: list[SumoSimulator] = []

    def begin(*neighbours: Neighbour, traffic: int = 0, seed: int = 1, warm_up: float = 0.0) -> SumoSimulator:
        town = CrowdedSumo(blocks, traffic=traffic, seed=seed, warm_up=warm_up)
        town.neighbours = neighbours
        running.append(town)
        return town

    yield begin
    for town in running:
        town.close()


@pytest.mark.parametrize(("lane", "station"), [("a_0", 40.0), ("a_1", 20.0), ("b_1", 60.0), ("goal_0", 10.0)])
def test_the_ego_appears_where_it_is_told(start: Start, blocks: RoadNetwork, lane: str, station: float) -> None:
    ego = start().reset(lane, station).ego
    at = blocks.lanes[lane].centre.pose_at(station)
    assert ego.pose == pytest.approx(at, abs=1e-6)
    assert ego.lane == lane
    assert (ego.length, ego.width) == (4.7, 1.9)
    assert ego.speed == pytest.approx(20 / 3.6)


def test_near_a_lanes_end_it_appears_so_slow_that_it_can_stop(start: Start, blocks: RoadNetwork) -> None:
    length = blocks.lanes["a_0"].length
    speed = start().reset("a_0", length - 8.0).ego.speed
    assert speed**2 / (2 * 2.0) <= 8.0 - 4.7 / 2


def test_steps_follow_the_dynamics_and_the_clock(start: Start) -> None:
    town = start()
    before = town.reset("a_0", 20.0)
    for i in range(1, 21):
        scene = town.step(Control(-1.0, 0.0))
        assert scene.time == pytest.approx(before.time + i * DT)
    assert scene.ego.speed == pytest.approx(before.ego.speed - 1.0)
    driven = scene.ego.pose.x - before.ego.pose.x
    assert driven == pytest.approx(before.ego.speed - 0.5, abs=1e-6)
    assert scene.ego.acceleration == pytest.approx(-1.0)


def test_a_follower_brakes_behind_a_slow_ego_and_does_not_hit_it(start: Start) -> None:
    town = start(Neighbour("a_0", -12.0, 5.5, 5.5))
    scene = town.reset("a_0", 40.0)
    (follower,) = scene.others.ids
    speeds, gaps = [], []
    for _ in range(120):
        scene = town.step(Control(-4.0, 0.0))
        speeds.append(float(scene.others.speed[0]))
        gaps.append(_gap(scene))
    assert follower == "beside0"
    assert speeds[0] > 5.0
    assert speeds[-1] < 0.5
    assert min(gaps) > 0.5


def test_a_car_ahead_is_seen_where_it_is_with_its_lane_and_speed(start: Start, blocks: RoadNetwork) -> None:
    scene = start(Neighbour("a_1", 30.0, 4.0, 4.0)).reset("a_0", 20.0)
    others = scene.others
    assert (others.ids, others.lanes) == (("beside0",), ("a_1",))
    station, offset = blocks.lanes["a_1"].centre.project(float(others.x[0]), float(others.y[0]))
    assert abs(offset) < 0.05
    assert station == pytest.approx(20.0 + 30.0 - float(others.length[0]) / 2, abs=1.0)
    assert abs(float(others.heading[0])) < 0.01
    assert float(others.speed[0]) == pytest.approx(4.0, abs=0.3)


def test_everyone_is_in_the_town_and_only_the_near_are_in_the_scene(start: Start) -> None:
    town = start(traffic=25, warm_up=5.0)
    scene = town.reset("a_0", 20.0)
    everyone = town.everyone()
    assert len(everyone) == 25
    assert set(scene.others.ids) < set(everyone.ids)
    assert list(scene.others.ids) == sorted(scene.others.ids)
    far = np.hypot(scene.others.x - scene.ego.pose.x, scene.others.y - scene.ego.pose.y)
    assert (far < 85.0).all()


def test_vehicles_stay_at_the_asked_count_with_plausible_yaw_rates() -> None:
    with SumoSimulator(load_map("millbrook"), traffic=60, seed=3, warm_up=30.0) as town:
        town.reset("park1e_0", 20.0)
        rates, speeds, turning = [], [], False
        for i in range(1200):
            scene = town.step(replace(COAST, acceleration=-8.0))
            if i % 10 == 0:
                cars = town.everyone()
                assert len(cars) == 60
                rates.append(np.abs(cars.yaw_rate).max())
                speeds.append(cars.speed.max())
                turning = turning or bool((np.abs(cars.yaw_rate) > 0.2).any())
        assert np.isfinite(scene.others.yaw_rate).all()
    assert turning
    assert max(rates) < 1.5
    assert max(speeds) < 7.0


def test_a_car_that_drives_straight_on_has_no_yaw_rate(start: Start) -> None:
    town = start(Neighbour("a_1", 20.0, 5.0, 5.0))
    town.reset("a_0", 10.0)
    for _ in range(60):
        scene = town.step(COAST)
        assert abs(float(scene.others.yaw_rate[0])) < 0.01


def test_lights_are_shown_as_they_are_at_every_step() -> None:
    import libsumo

    town = load_map("millbrook")
    shown = set()
    with SumoSimulator(town, traffic=0, seed=3, warm_up=0.0) as simulator:
        simulator.reset("park1e_0", 20.0)
        for _ in range(round(100.0 / DT)):
            scene = simulator.step(replace(COAST, acceleration=-8.0))
            assert scene.signals == {name: libsumo.trafficlight.getRedYellowGreenState(name) for name in town.signals}
            shown.add(tuple(scene.signals.values()))
    assert len(shown) > 5


def test_an_ego_that_sumo_finds_on_no_lane_for_a_step_is_still_there(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    import libsumo

    town = start()
    town.reset("a_0", 20.0)
    monkeypatch.setattr(libsumo.vehicle, "getContextSubscriptionResults", lambda _: {})
    assert town.step(COAST).ego.lane == "a_0"
    libsumo.vehicle.remove("ego")
    with pytest.raises(SimulatorError):
        town.step(COAST)


def test_the_same_seed_gives_the_same_traffic_and_another_one_another(start: Start) -> None:
    def cars(seed: int) -> tuple[tuple[str, ...], list[float]]:
        town = start(traffic=10, seed=seed, warm_up=10.0)
        town.reset("a_0", 20.0)
        everyone = town.everyone()
        town.close()
        return everyone.ids, everyone.x.tolist()

    assert cars(1) == cars(1) != cars(2)


def test_signals_are_told_by_one_letter_for_each_link() -> None:
    roads = load_map("millbrook")
    with SumoSimulator(roads, traffic=0, seed=1, warm_up=0.0) as town:
        scene = town.reset("park1e_0", 20.0)
    assert set(scene.signals) == set(roads.signals)
    for light, letters in scene.signals.items():
        assert len(letters) == len(roads.signals[light].phases[0][1])
        assert set(letters) <= set("GgyYrRuosO")


def test_a_start_on_a_dead_end_is_no_trouble(spur_net: Path) -> None:
    with SumoSimulator(load_map(spur_net), traffic=3, seed=1, warm_up=1.0) as town:
        scene = town.reset("spur_0", 30.0)
        town.announce(["spur_0"])
        for _ in range(20):
            scene = town.step(COAST)
        assert scene.ego.lane == "spur_0"


def test_a_command_beyond_the_limits_is_refused(start: Start) -> None:
    town = start()
    town.reset("a_0", 20.0)
    with pytest.raises(InvalidStateError):
        town.step(Control(math.nan, 0.0))


def test_a_step_before_the_ego_is_there_is_refused(start: Start) -> None:
    with pytest.raises(SimulatorError, match="before reset"):
        start().step(COAST)


def test_a_map_whose_file_is_gone_is_named(blocks: RoadNetwork) -> None:
    gone = replace(blocks, source="gone.net.xml")
    with pytest.raises(SimulatorError, match=r"blocks: SUMO needs the map's file, and 'gone.net.xml' is none"):
        SumoSimulator(gone, traffic=0, seed=1)


def test_a_second_simulation_starts_after_the_first_is_closed(blocks: RoadNetwork) -> None:
    for _ in range(3):
        with SumoSimulator(blocks, traffic=2, seed=1, warm_up=0.0) as town:
            assert town.reset("a_0", 20.0).ego.lane == "a_0"


def _gap(scene: Scene) -> float:
    """Return the way from the follower's front bumper to the ego's rear one [m]."""
    ego = scene.ego
    return ego.pose.x - float(scene.others.x[0]) - (ego.length + float(scene.others.length[0])) / 2


class JammedSumo(SumoSimulator):
    """A queue stands at the ego's place, and beside it one who wants to change into any gap there."""

    def _await(self, spot: Spot) -> str | None:
        road, vehicle = self._network.lanes[spot.lane].edge, self._sumo.vehicle
        self._sumo.route.add("on", [road])
        for name, lane, ahead in [("before", 0, 9.0), ("there", 0, 2.0), ("behind", 0, -7.0), ("beside", 1, 2.0)]:
            vehicle.add(name, "on", departLane=str(lane), departPos=str(spot.station + ahead))
            vehicle.moveTo(name, f"{road}_{lane}", spot.station + ahead)
            vehicle.setSpeed(name, 0.0)
            vehicle.setLaneChangeMode(name, 0)
        vehicle.changeLane("beside", 0, 1000.0)
        vehicle.setLaneChangeMode("beside", 512)  # when there is room
        return None


def test_in_a_standing_queue_the_ego_takes_a_place_that_nobody_slips_into(
    blocks: RoadNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sumo, "PATIENCE", 1.0)
    with JammedSumo(blocks, traffic=0, seed=1, warm_up=0.0) as town:
        scene = town.reset("a_0", 40.0)
        assert "beside" in scene.others.ids
        for _ in range(20):
            assert not overlapping(box_of(scene.ego), scene.others)
            scene = town.step(Control(-3.0, 0.0))
