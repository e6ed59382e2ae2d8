from __future__ import annotations

import gzip
import json
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tmpud.roads import load_map, shipped_towns
from tmpud.roads.loading import map_file
from tmpud.roads.moves import Move, largest_strong_part, moves
from tmpud.roads.network import RoadNetwork
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.symbols import Action

TOOLS = Path(__file__).resolve().parents[2] / "tools"
Plan = tuple[float, tuple[tuple[str, Move], ...]]  # length [m], (segment, move from it)


@cache
def millbrook() -> RoadNetwork:
    return load_map("millbrook")


def length(network: RoadNetwork, segment: str, move: Move) -> float:
    """Return the centre-line length between the middles of a move's segments [m]."""
    here, there = network.segments[segment], network.segments[move.segment]
    if network.ahead(segment):
        return there.middle - here.middle
    through = next(c for c in network.outgoing(here.lane) if c.to_lane == there.lane)
    return here.end - here.middle + through.path.length + there.middle


def plans(network: RoadNetwork, start: str, goals: set[str], longest: float) -> Iterator[Plan]:
    """Yield every way from a segment to a goal that meets no segment twice and is not too long."""
    stack: list[tuple[str, Plan]] = [(start, (0.0, ()))]
    while stack:
        segment, (metres, way) = stack.pop()
        if segment in goals:
            yield metres, way
            continue
        driven = {start, *(move.segment for _, move in way)}
        for move in moves(network, segment):
            total = metres + length(network, segment, move)
            if move.segment not in driven and total <= longest:
                stack.append((move.segment, (total, (*way, (segment, move)))))


def merges(plan: Plan) -> list[str]:
    return [segment for segment, move in plan[1] if move.action.is_merge]


@cache
def mission_plans() -> list[Plan]:
    """Return the plans of Millbrook's mission, by length and then number of merges."""
    network, mission = millbrook(), PAPER_MISSIONS["millbrook"]
    goals = {s.id for lane in network.edges[mission.goal] for s in network.segments_of(lane)}
    found = plans(network, f"{mission.start}/0", goals, longest=800.0)
    return sorted(found, key=lambda plan: (round(plan[0], 2), len(merges(plan))))


@pytest.mark.parametrize("town", shipped_towns())
def test_a_town_has_signals_lanes_and_no_segment_that_is_cut_off(town: str) -> None:
    network = load_map(town)
    assert network.warnings == ()
    assert sum(junction.kind == "traffic_light" for junction in network.junctions.values()) >= 12
    assert sum(lane.length for lane in network.lanes.values()) >= 10_000
    assert {len(row) for row in network.edges.values()} == {2, 3}
    assert largest_strong_part(network) == network.segments.keys()


@pytest.mark.parametrize("town", shipped_towns())
def test_every_road_of_a_town_has_room_for_a_merge(town: str) -> None:
    network = load_map(town)
    for row in network.edges.values():
        assert any(move.action is Action.MERGELEFT for move in moves(network, f"{row[0]}/0"))


@pytest.mark.parametrize("town", shipped_towns())
def test_opposing_lanes_are_apart(town: str) -> None:
    network = load_map(town)
    streets = {edge[:-1] for edge in network.edges}
    for street in streets:
        one, other = (row[-1] for edge, row in network.edges.items() if edge[:-1] == street)
        middle = network.lanes[one].centre.pose_at(network.lanes[one].length / 2)
        assert abs(network.lanes[other].centre.project(middle.x, middle.y)[1]) >= 4.49


def test_the_first_two_plans_of_the_mission_differ_only_in_where_they_merge() -> None:
    first, second = mission_plans()[:2]
    assert first[0] == pytest.approx(second[0], abs=0.005)
    assert first[0] == pytest.approx(430.3, abs=0.1)
    assert sorted([merges(first), merges(second)]) == [["park1e_0/0"], ["park2e_0/0"]]


def test_five_plans_of_the_mission_go_by_five_lane_changing_areas() -> None:
    shortest: dict[str, float] = {}
    for plan in mission_plans():
        shortest.setdefault(merges(plan)[0], round(plan[0]))
    assert shortest == {
        "park1e_0/0": 430,  # A: merge left in the first block of Park Street
        "park2e_0/0": 430,  # B: in the second
        "mill2s_0/0": 717,  # C: right at Mill Street, merge left there, round by the Avenue
        "park3e_0/0": 772,  # D: past High Street, merge left in the third block, round by East Street
        "park3e_0/1": 772,  # E: the same, merging one segment later
    }


def test_a_town_is_what_its_sources_build(tmp_path: Path) -> None:
    subprocess.run([sys.executable, str(TOOLS / "build_towns.py"), "--output", str(tmp_path)], check=True, timeout=120)
    assert sorted(path.name for path in tmp_path.iterdir()) == [map_file(town).name for town in shipped_towns()]
    for town in shipped_towns():  # unpacked: other releases of zlib pack the same text otherwise
        built = gzip.decompress((tmp_path / f"{town}.net.xml.gz").read_bytes())
        assert built == gzip.decompress(map_file(town).read_bytes())


@pytest.mark.parametrize("town", shipped_towns())
def test_sumo_s_own_cars_neither_collide_nor_get_stuck(town: str) -> None:
    command = [sys.executable, str(TOOLS / "check_traffic.py"), town, "--vehicles", "120", "--seconds", "400"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    found = json.loads(done.stdout)
    assert (done.returncode, found["collisions"], found["running"]) == (0, 0, 120)
    assert found["late_mean_speed"] > 1.5
