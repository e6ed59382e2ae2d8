import random
from pathlib import Path

import pytest

from tests.task.tiny_roads import link, network, road
from tmpud.errors import SimulatorError
from tmpud.roads import load_map, shipped_towns
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import request
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.simulators.traffic import AHEAD, SPACING, Circulation, TrafficRules


def circulation(roads: RoadNetwork, seed: int = 1) -> Circulation:
    return Circulation(roads, random.Random(seed))


def around_the_mission(roads: RoadNetwork, rules: TrafficRules | None = None) -> Circulation:
    mission = PAPER_MISSIONS["millbrook"]
    return Circulation(roads, random.Random(1), request(roads, mission.start, (mission.goal,)), rules)


def following(roads: RoadNetwork, before: str) -> set[str]:
    ways = (way for lane in roads.edges[before] for way in roads.outgoing(lane))
    return {roads.lanes[way.to_lane].edge for way in ways}


@pytest.mark.parametrize("town", shipped_towns())
def test_random_walks_stay_on_roads_that_follow_and_never_run_out(town: str) -> None:
    roads = load_map(town)
    town_traffic = circulation(roads)
    for start in sorted(roads.edges):
        if start not in town_traffic:
            continue
        walk = town_traffic.walk(start, 200)
        assert len(walk) >= 200
        for before, after in zip([start, *walk], walk, strict=False):
            assert after in following(roads, before)
            assert after in town_traffic


def test_a_road_that_leads_only_to_a_dead_end_does_not_circulate(spur_net: Path) -> None:
    roads = load_map(spur_net)
    ring = circulation(roads)
    assert {road for road in roads.edges if road in ring} == {"ab", "bc", "ca"}
    assert all("spur" not in ring.walk("ab", 100) for _ in range(20))


def test_a_walk_from_outside_goes_as_far_as_the_roads_do(spur_net: Path) -> None:
    assert circulation(load_map(spur_net)).walk("spur") == []
    into_a_ring = network([road("a"), road("b")], [link("a_0", "b_0"), link("b_0", "b_0")])
    assert circulation(into_a_ring).walk("a") == ["b"] * AHEAD


def test_local_cars_go_where_the_mission_does_and_the_others_everywhere() -> None:
    roads = load_map("millbrook")
    town_traffic = around_the_mission(roads)
    way = {"park1e", "park2e", "high3n", "high4n"}
    near, anywhere = (town_traffic.walk("park1e", 3000, local=local) for local in (True, False))
    share = [sum(road in way for road in walk) / len(walk) for walk in (near, anywhere)]
    assert share[0] > 0.4 > 0.15 > share[1]
    assert set(anywhere) == set(roads.edges)


def test_the_number_of_local_cars_depends_on_the_missions_lanes_and_not_on_how_many_cars_there_are() -> None:
    roads = load_map("millbrook")
    town_traffic = around_the_mission(roads)
    length = sum(roads.lanes[f"{road}_{i}"].length for road in ("park1e", "park2e", "high3n", "high4n") for i in (0, 1))
    assert (
        town_traffic.locals_among(120) == town_traffic.locals_among(200) == round(TrafficRules().local * length / 1000)
    )
    assert town_traffic.locals_among(10) == 10
    assert circulation(roads).locals_among(120) == 0


def test_local_cars_are_limited_on_long_missions_and_none_go_round_a_single_road() -> None:
    roads = load_map("millbrook")
    rules = TrafficRules()

    def local(start: str, goal: str, vehicles: int) -> int:
        return Circulation(roads, random.Random(1), request(roads, start, (goal,)), rules).locals_among(vehicles)

    assert local("quay1e_0", "north3e", 200) == rules.most_local
    assert local("quay1e_0", "north3e", 20) == 20
    assert local("park1e_0", "park1e", 200) == 0


def test_a_greater_detour_makes_more_roads_the_missions() -> None:
    roads = load_map("millbrook")
    lengths = []
    for detour in (0.0, 350.0, 700.0):
        rules = TrafficRules(detour=detour, local=10.0, most_local=1000)
        lengths.append(around_the_mission(roads, rules).locals_among(1000))
    assert lengths == sorted(set(lengths))


def test_a_mission_by_way_of_other_places_is_followed_leg_by_leg() -> None:
    names = "abcd"
    links = [link(f"{x}_0", f"{y}_0") for x, y in zip(names, "bcda", strict=True)]
    ring = network([road(name, 1, 100.0) for name in names], links)
    rules = TrafficRules(local=10.0, detour=0.0)  # one car on each lane of 100 m

    def mission_lanes(*vias: str) -> int:
        return Circulation(ring, random.Random(1), request(ring, "a", ("b",), vias), rules).locals_among(1000)

    assert (mission_lanes(), mission_lanes("c")) == (2, 4)


def test_places_are_spaced_out_on_their_lanes() -> None:
    roads = network([road("a", 2, 200.0), road("b", 1, 30.0)], [link("a_0", "b_0"), link("b_0", "a_0")])
    places = circulation(roads).places(20)
    assert len(set(places)) == 20
    for lane, station in places:
        assert SPACING / 2 < station < roads.lanes[lane].length
        others = [other for where, other in places if where == lane and other != station]
        assert all(abs(other - station) > SPACING - 1e-9 for other in others)


def test_the_seed_decides_walks_and_places() -> None:
    roads = load_map("millbrook")
    one, same, other = (circulation(roads, seed) for seed in (1, 1, 2))
    start = min(road for road in roads.edges if road in one)
    assert (one.places(50), one.walk(start)) == (same.places(50), same.walk(start))
    assert one.places(50) != other.places(50)


def test_more_vehicles_than_there_is_room_for_are_refused() -> None:
    roads = network([road("a", 1, 100.0)], [link("a_0", "a_0")])
    with pytest.raises(SimulatorError, match="1000 vehicles do not fit on tiny: there is room for 7"):
        circulation(roads).places(1000)
    assert len(circulation(roads).places(7)) == 7


def test_no_vehicles_need_no_road_to_circulate_on() -> None:
    dead_end = network([road("a"), road("b")], [link("a_0", "b_0")])
    assert circulation(dead_end).places(0) == []
    with pytest.raises(SimulatorError, match="tiny: no road on which traffic could circulate"):
        circulation(dead_end).places(1)
