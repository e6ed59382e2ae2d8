import gzip
import json
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.execution.test_worked_case import finished
from tests.simulators.crowded import Neighbour, among
from tmpud.errors import MapError, RequestError, SimulatorError
from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Planned
from tmpud.execution.timing import Stopwatch
from tmpud.presets import TMPUD
from tmpud.protocols import Simulator
from tmpud.roads.network import RoadNetwork
from tmpud.runner import STATUS, Mission, drive
from tmpud.scene import Control, Outcome, Scene
from tmpud.simulators import sumo
from tmpud.simulators.sumo import SumoSimulator

RECORD = """
import sys
from pathlib import Path
from tmpud.recording import record
from tmpud.runner import Mission, drive
map_, start, goal, traffic, folder = sys.argv[1:]
mission = Mission(map=map_, start=start, goal=goal, traffic=int(traffic), seed=11)
for event in record(drive(mission), Path(folder)):
    pass
print(event.status, len(event.message))
"""


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Begin at one phase of the lights, so that there is little to warm up."""
    monkeypatch.setattr(sumo, "CYCLE", 0.0)


@pytest.fixture
def mission(blocks_net: Path) -> Mission:
    return Mission(map=str(blocks_net), start="a_0", goal="goal", traffic=0)


@pytest.fixture
def events(mission: Mission) -> list[Event]:
    return list(drive(mission, simulator=among(Neighbour("a_0", 25.0, 4.0, 4.0))))


def test_a_run_goes_from_its_header_to_its_end(events: list[Event]) -> None:
    kinds = [type(event) for event in events]
    assert (kinds[0], kinds[1], kinds[-1]) == (Header, Planned, Finished)
    assert kinds.count(Header) == kinds.count(Finished) == 1
    times = [event.time for event in events[1:]]
    assert times == sorted(times)


def test_frames_are_a_tenth_of_a_second_apart_and_hold_everyone(events: list[Event]) -> None:
    frames = [event for event in events if isinstance(event, Frame)]
    assert len(frames) > 300
    assert all(later.time - sooner.time == pytest.approx(0.1) for sooner, later in pairwise(frames))
    assert all(frame.ids == ("beside0",) and len(frame.others) == 1 for frame in frames)


def test_frames_can_be_left_out_and_nothing_else_changes(mission: Mission, events: list[Event]) -> None:
    bare = list(drive(mission, simulator=among(Neighbour("a_0", 25.0, 4.0, 4.0)), frames=False))
    assert bare == [event for event in events if not isinstance(event, Frame)]


def test_other_plans_can_be_left_out_and_nothing_else_changes(mission: Mission, events: list[Event]) -> None:
    bare = list(drive(mission, simulator=among(Neighbour("a_0", 25.0, 4.0, 4.0)), alternatives=0))
    assert any(isinstance(event, Planned) and event.alternatives for event in events)
    assert bare == [replace(event, alternatives=()) if isinstance(event, Planned) else event for event in events]


def test_every_action_begins_on_an_estimate_of_its_own_moment(events: list[Event]) -> None:
    decisions = [event for event in events if isinstance(event, Estimated | Executed | Frame)]
    for i, event in enumerate(decisions):
        if isinstance(event, Executed):
            before = [e for e in decisions[:i] if isinstance(e, Estimated)]
            assert event.estimated
            assert before[-1].step == event.step


def test_the_distance_is_the_length_of_the_path_in_the_frames(events: list[Event]) -> None:
    frames = [event.ego for event in events if isinstance(event, Frame)]
    driven = sum(((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5 for a, b in pairwise(frames)) / 100
    assert finished(tuple(events)).distance == pytest.approx(driven, abs=2.0)


def test_behind_a_slower_car_the_drive_tells_its_time_to_collision_and_its_jerk(events: list[Event]) -> None:
    metrics = finished(tuple(events)).metrics
    assert set(metrics) == {"collisions", "forced_stops", "violations", "min_ttc", "rms_jerk", "max_jerk"}
    assert metrics["collisions"] == 0 < metrics["min_ttc"]
    assert 0 < metrics["rms_jerk"] < metrics["max_jerk"]


def test_the_header_says_all_it_takes_to_run_it_again(events: list[Event], mission: Mission) -> None:
    header = events[0]
    assert isinstance(header, Header)
    again = {name: header.mission[name] for name in Mission.__dataclass_fields__}
    assert Mission(**again) == mission
    assert header.mission["settings"]["gamma"] == TMPUD.gamma
    assert len(header.map["digest"]) == 64
    assert set(header.versions) == {"tmpud", "clingo", "libsumo", "numpy", "python"}
    assert header.time == 0.0


def test_the_stopwatch_measures_plans_and_estimates(mission: Mission) -> None:
    watch = Stopwatch()
    events = list(drive(mission, simulator=among(), stopwatch=watch, frames=False))
    kinds = [latency.kind for latency in watch.latencies]
    assert kinds.count("estimate") == sum(isinstance(event, Estimated) for event in events)
    assert kinds.count("plan") >= sum(isinstance(event, Planned) for event in events)
    assert all(latency.milliseconds >= 0 for latency in watch.latencies)


def test_every_way_an_action_can_end_a_drive_has_its_status() -> None:
    assert {outcome for outcome in Outcome if outcome is not Outcome.INFEASIBLE} == set(STATUS)
    assert len(set(STATUS.values())) == len(STATUS)


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"map": "atlantis"}, MapError),
        ({"start": "nowhere"}, RequestError),
        ({"goal": "nowhere"}, RequestError),
        ({"via": ("nowhere",)}, RequestError),
        ({"preset": "none"}, RequestError),
        ({"algorithm": "none"}, RequestError),
    ],
)
def test_what_cannot_be_run_is_refused_before_the_first_event(
    mission: Mission, change: dict[str, Any], error: type[Exception]
) -> None:
    with pytest.raises(error):
        next(drive(replace(mission, **change)))


def test_too_many_vehicles_are_refused(mission: Mission) -> None:
    with pytest.raises(SimulatorError, match="5000 vehicles do not fit on blocks"):
        list(drive(replace(mission, traffic=5000)))


def test_five_hundred_vehicles_find_room_and_the_ego_takes_the_place_of_one() -> None:
    def make(network: RoadNetwork, mission: Mission) -> Simulator:
        return SumoSimulator(network, traffic=mission.traffic, seed=mission.seed, warm_up=1.0)

    packed = Mission(map="millbrook", start="park1e_0", goal="park2e", traffic=500)
    run = drive(packed, simulator=make)
    frame = next(event for event in run if isinstance(event, Frame))
    run.close()  # type: ignore[attr-defined]
    assert len(set(frame.ids)) == len(frame.others) == 499


def test_a_state_that_is_not_finite_is_an_invalid_state_and_the_simulator_is_closed(mission: Mission) -> None:
    closed = []

    class Broken(SumoSimulator):
        def step(self, control: Control) -> Scene:
            scene = super().step(control)
            return replace(scene, ego=replace(scene.ego, speed=float("nan")))

        def close(self) -> None:
            closed.append(True)
            super().close()

    def make(network: RoadNetwork, mission: Mission) -> Simulator:
        return Broken(network, traffic=0, seed=mission.seed, warm_up=0.0)

    events = tuple(drive(mission, simulator=make, frames=False))
    assert finished(events).status == "INVALID_STATE"
    assert closed == [True]


def test_the_simulator_is_closed_where_a_run_is_broken_off(mission: Mission) -> None:
    run = drive(mission, simulator=among())
    for _ in range(5):
        next(run)
    run.close()  # type: ignore[attr-defined]
    assert finished(tuple(drive(mission, simulator=among()))).status == "SUCCESS"


def test_an_error_of_the_simulator_is_no_outcome_of_driving(mission: Mission) -> None:
    class Dying(SumoSimulator):
        def step(self, control: Control) -> Scene:  # noqa: ARG002
            raise SimulatorError("SUMO died")

    def make(network: RoadNetwork, mission: Mission) -> Simulator:
        return Dying(network, traffic=0, seed=mission.seed, warm_up=0.0)

    end = finished(tuple(drive(mission, simulator=make)))
    assert (end.status, end.message) == ("SIM_CRASH", "SUMO died")


@pytest.mark.parametrize("town", ["blocks", "millbrook"])
def test_the_same_seed_gives_the_same_log_in_two_processes_with_other_hash_seeds(
    town: str, blocks_net: Path, tmp_path: Path
) -> None:
    places = {"blocks": (str(blocks_net), "a_0", "goal", "15"), "millbrook": ("millbrook", "park2e_1", "high3n", "40")}
    logs = []
    for hash_seed in ("1", "2"):
        folder = tmp_path / f"run{hash_seed}"
        subprocess.run(
            [sys.executable, "-c", RECORD, *places[town], str(folder)],
            check=True,
            capture_output=True,
            timeout=120,
            env={"PYTHONHASHSEED": hash_seed, "PATH": ""},
        )
        logs.append((folder / "run.jsonl.gz").read_bytes())
    assert logs[0] == logs[1]
    rows = [json.loads(line) for line in gzip.decompress(logs[0]).splitlines()]
    assert rows[-1]["event"] == "Finished"
    assert any(row["event"] == "Frame" and len(row["ids"]) == int(places[town][3]) for row in rows)
