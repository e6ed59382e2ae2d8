import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from tmpud.dynamics import EGO
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.scene import Control
from tmpud.simulators.conventions import DT
from tmpud.simulators.local import CAR_LENGTH, Condition, LocalRoads, PlacementLaw
from tmpud.simulators.local_roads import APART, LENGTH, write_net
from tmpud.symbols import Action

COAST = Control(0.0, 0.0)
DENSE = Condition(neighbours=3, acceleration=1.0)
LAW = PlacementLaw()


@pytest.fixture
def dense() -> Iterator[LocalRoads]:
    with LocalRoads(DENSE, 20, seed=1) as roads:
        yield roads


def test_the_net_has_roads_of_two_lanes_between_which_cars_may_change(tmp_path: Path) -> None:
    network = read_sumo_net(write_net(tmp_path, 3))
    assert len(network.lanes) == 6
    for number in range(3):
        right, left = (network.lanes[f"road{number}_{lane}"] for lane in range(2))
        assert network.neighbour(right.id, Action.MERGELEFT) == left
        assert network.may_change(right.id, Action.MERGELEFT)
        assert network.may_change(left.id, Action.MERGERIGHT)
        assert right.length == left.length == LENGTH
        assert (right.centre.points[0][1] + left.centre.points[0][1]) / 2 == number * APART


def test_neighbours_appear_around_the_ego_as_the_law_says(dense: LocalRoads) -> None:
    sides = set()
    for scene in dense.scenes.values():
        assert len(scene.others) == 3
        assert scene.ego.pose.x == LAW.ego_station
        assert set(scene.others.lanes) <= {"road0_0", "road0_1"}
        rows = [(scene.ego.lane, scene.ego.pose.x), *zip(scene.others.lanes, scene.others.x.tolist(), strict=True)]
        for i, (lane, x) in enumerate(rows):
            assert abs(x - LAW.ego_station) <= LAW.reach + 1e-6
            assert all(lane != other or abs(x - y) >= CAR_LENGTH + LAW.gap - 1e-6 for other, y in rows[:i])
        sides |= {(lane != scene.ego.lane, x > LAW.ego_station) for lane, x in rows[1:]}
    assert len(sides) == 4  # before and behind, on either lane


def test_every_scene_is_in_the_frame_of_the_first_road(dense: LocalRoads) -> None:
    for scene in dense.scenes.values():
        for lane, y in zip(scene.others.lanes, scene.others.y.tolist(), strict=True):
            assert y == pytest.approx({"road0_0": -1.75, "road0_1": 1.75}[lane])


@pytest.mark.parametrize("bound", [0.0, 1.0])
def test_a_free_neighbour_changes_its_speed_by_no_more_than_its_factor(
    bound: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(LocalRoads, "_places", lambda self, origin: [(1 - origin, LAW.ego_station + 20)])  # noqa: ARG005
    with LocalRoads(Condition(neighbours=1, acceleration=bound), 20, seed=1) as roads:
        first = {road: float(scene.others.speed[0]) for road, scene in roads.scenes.items()}
        for _ in range(round(2.0 / DT)):
            roads.step(dict.fromkeys(first, COAST))
        change = {road: float(scene.others.speed[0]) - first[road] for road, scene in roads.scenes.items()}
    assert max(map(abs, change.values())) <= 2.0 * bound + 0.1  # drivers dawdle a little
    if bound:
        assert max(change.values()) > 0.3
        assert min(change.values()) < -0.3


def test_the_ego_moves_as_its_dynamics_say_and_is_seen_by_its_front_bumper(dense: LocalRoads) -> None:
    road, scene = next(iter(dense.scenes.items()))
    steering = 0.1 if scene.ego.lane == "road0_0" else -0.1
    seen: list[str] = []
    while abs(scene.ego.pose.y) > 0.1 and len(seen) < 100:
        dense.step({road: Control(0.0, steering)})
        scene = dense.scenes[road]
        seen.append(scene.ego.lane)
        bumper = scene.ego.pose.y + EGO.length / 2 * math.sin(scene.ego.pose.heading)
        if abs(bumper) > 0.2:
            assert scene.ego.lane == ("road0_1" if bumper > 0 else "road0_0")
    assert len(set(seen)) == 2
    assert scene.ego.speed == pytest.approx(20 / 3.6)


def test_a_road_that_has_ended_is_empty(dense: LocalRoads) -> None:
    dense.end(3)
    dense.step(dict.fromkeys(dense.scenes, COAST))
    assert 3 not in dense.scenes
    assert len(dense.scenes) == 19
    assert len(dense.scenes[4].others) == 3
