"""The crossroads: links 0 and 1 go straight on eastwards, 3 crosses them northwards, 4 turns right into 0's lane."""

from dataclasses import replace

import pytest

from tests.judging.roads import crossroads
from tmpud.geometry import Pose
from tmpud.motion.right_of_way import PATIENCE, RightOfWay
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Scene, Vehicles, VehicleState

STRAIGHT, LEFT, CROSS = 0, 2, 3


def roads(*, priority: str = "m", signal: bool = False) -> RoadNetwork:
    """Return the crossroads where the side road gives way to the main one, with or without a light."""
    yields = {CROSS: (0, 1), 4: (0,)}
    foes = {0: (3, 4), 1: (3,), 2: (), 3: (0, 1), 4: (0,)}
    plain = crossroads(priority)
    ways = [
        replace(way, foes=foes[i], yields_to=yields.get(i, ()), signal="J" if signal else None)
        for i, way in enumerate(plain.connections)
    ]
    return RoadNetwork("crossroads", plain.lanes, tuple(ways), {}, {}, segment_length=50.0)


def on_main(x: float, speed: float = 5.5, lane: str = "in_0") -> VehicleState:
    return VehicleState(f"main {x:g}", Pose(x, 0.0, 0.0), lane, speed=speed)


def may_enter(
    *others: VehicleState,
    network: RoadNetwork | None = None,
    way: int = CROSS,
    letters: str = "GGGGG",
    distance: float = 2.0,
    standing: float = 1.0,
    speed: float = 2.0,
) -> bool:
    ego = VehicleState("ego", Pose(110.0, -14.0, 1.5708), "side_0", speed=speed)
    scene = Scene(0.0, ego, Vehicles.of(list(others)), {"J": letters})
    return RightOfWay(network or roads()).may_enter(scene, way, distance, standing)


def test_an_empty_junction_may_be_entered() -> None:
    assert all(may_enter(way=way) for way in (STRAIGHT, LEFT, CROSS, 4))


@pytest.mark.parametrize(("letter", "free"), [("r", False), ("u", False), ("G", True), ("g", True), ("o", True)])
def test_a_light_says_who_goes(letter: str, free: bool) -> None:
    assert may_enter(network=roads(signal=True), letters=f"rrr{letter}r") is free


@pytest.mark.parametrize(
    ("speed", "distance", "goes_on"), [(5.5, 20.0, False), (5.5, 6.0, False), (5.5, 4.0, True), (2.0, 2.0, False)]
)
def test_at_yellow_it_stops_where_it_can_and_goes_on_where_it_cannot(
    speed: float, distance: float, goes_on: bool
) -> None:
    here = roads(signal=True)
    assert may_enter(network=here, letters="rrryr", speed=speed, distance=distance) is goes_on


def test_at_a_stop_sign_it_stands_first() -> None:
    here = roads(priority="s")
    assert not may_enter(network=here, standing=0.0)
    assert may_enter(network=here, standing=0.1)
    assert may_enter(network=roads(priority="m"), standing=0.0)


def test_a_light_that_is_on_outranks_a_stop_sign() -> None:
    assert may_enter(network=roads(priority="s", signal=True), letters="rrrGr", standing=0.0)


@pytest.mark.parametrize(("x", "free"), [(95.0, False), (80.0, False), (70.0, False), (50.0, True), (5.0, True)])
def test_it_lets_those_arrive_who_go_first_and_takes_a_gap_long_enough(x: float, free: bool) -> None:
    assert may_enter(on_main(x)) is free


def test_who_goes_first_does_not_wait_for_those_who_do_not() -> None:
    side = VehicleState("side", Pose(110.0, -16.0, 1.5708), "side_0", speed=4.0)
    assert may_enter(side, way=STRAIGHT)


def test_green_without_give_way_needs_no_look_at_those_arriving() -> None:
    here = roads(signal=True)
    assert may_enter(on_main(90.0), network=here, letters="GGGGG")
    assert not may_enter(on_main(90.0), network=here, letters="GGGgG")


def test_those_at_a_red_light_do_not_arrive() -> None:
    assert may_enter(on_main(90.0), network=roads(signal=True), letters="rrrgr")


def test_a_vehicle_inside_the_junction_is_let_out_whoever_goes_first() -> None:
    inside = VehicleState("inside", Pose(110.0, -5.0, 1.5708), ":J_3_0", speed=3.0)
    assert not may_enter(inside, way=STRAIGHT)
    assert not may_enter(on_main(105.0, lane=":J_0_0"), letters="GGGGG", network=roads(signal=True))


def test_a_vehicle_that_has_left_the_shared_place_is_no_hindrance() -> None:
    assert may_enter(on_main(118.0, lane=":J_0_0"), way=CROSS)


def test_a_vehicle_that_waits_inside_before_the_shared_place_lets_one_go_first() -> None:
    waits = VehicleState("waits", Pose(110.0, -7.0, 1.5708), ":J_3_0", speed=0.0)
    assert may_enter(waits, way=STRAIGHT)
    goes_first = on_main(102.4, speed=0.0, lane=":J_0_0")
    assert not may_enter(goes_first, way=CROSS)


def test_those_who_stand_at_the_line_are_taken_to_wait_after_some_patience() -> None:
    stands = on_main(97.0, speed=0.0)
    assert not may_enter(stands, standing=PATIENCE - 0.1)
    assert may_enter(stands, standing=PATIENCE + 0.1)
    assert not may_enter(on_main(97.0, speed=1.0), standing=PATIENCE + 0.1)


def test_paths_that_keep_apart_share_no_place() -> None:
    here = RightOfWay(roads())
    assert here.shared(0, 1) is None
    shared = here.shared(STRAIGHT, CROSS)
    assert shared is not None
    assert shared.enter < 10.0 < shared.leave
    assert shared.other_enter < 10.0 < shared.other_leave
