"""Whole drives on the loopback server: a kinematic one, so nothing here is said of CARLA's physics."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tests.carla_loopback.running import loopback
from tmpud.cli import app
from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.events import Finished, Header
from tmpud.experiments.kinds import KINDS, read_findings
from tmpud.experiments.trials.carla import CarlaTrials
from tmpud.experiments.trials.grid import Grid, Route, cells
from tmpud.roads import load_map
from tmpud.roads.sumo_tools import run_tool
from tmpud.runner import Mission, carla, drive
from tmpud.simulators.carla.maps import fetch
from tmpud.simulators.carla.session import Address
from tmpud.simulators.carla.simulator import CarlaSimulator

GRID = Grid(missions=(Route("b_1", "goal_0"),), traffic={"few": 3}, algorithms=("threshold(0.3)",), seeds=(1,))


def test_a_mission_is_driven_to_its_goal(blocks_net: Path, blocks_xodr: Path) -> None:
    mission, town = Mission(map=str(blocks_net), start="b_0", goal="goal_0", seed=1), load_map(blocks_net)
    with loopback(blocks_xodr) as server:
        at = Address(port=server.port)
        events = list(
            drive(mission, simulator=lambda *_: CarlaSimulator(town, traffic=6, seed=1, server=at, warm_up=1))
        )
        assert server.report()["actors"] == {}
    header, end = events[0], events[-1]
    assert isinstance(header, Header)
    assert header.versions["carla"] == "0.9.16"
    assert isinstance(end, Finished)
    assert (end.status, end.message) == ("SUCCESS", "")


@pytest.mark.parametrize(("fault", "status"), [("die_at", "SIM_CRASH"), ("freeze_at", "SIM_HANG")])
def test_a_server_that_ends_within_a_drive_has_a_status_of_its_own(
    blocks_net: Path, blocks_xodr: Path, fault: str, status: str
) -> None:
    mission = Mission(map=str(blocks_net), start="a_0", goal="goal_0", traffic=0, seed=1)
    with loopback(blocks_xodr) as server:
        events = drive(mission, simulator=carla(Address(port=server.port, patience=1.0)))
        seen = [next(events)]
        server.arm(**{fault: 10})
        seen += events
    assert isinstance(seen[-1], Finished)
    assert seen[-1].status == status
    assert f"CARLA at 127.0.0.1:{server.port}" in seen[-1].message


def test_a_map_of_the_servers_is_fetched_and_a_local_one_is_not(
    blocks_xodr: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with loopback(blocks_xodr) as server:
        file = fetch(Address(port=server.port), "blocks")
    assert Path(file).is_relative_to(tmp_path)
    town = load_map(file)
    assert (town.name, len(town.lanes)) == ("blocks", len(load_map(blocks_xodr).lanes))
    assert fetch(Address(port=server.port), "millbrook") == "millbrook"


def test_without_a_server_there_is_one_line_that_names_it() -> None:
    where = ["--sim", "carla", "--port", "1", "--map", "Town05"]
    told = CliRunner().invoke(app, ["drive", "--from", "random", "--to", "random", *where])
    assert isinstance(told.exception, SimulatorError)
    assert "no CARLA server at 127.0.0.1:1" in str(told.exception)


def test_a_map_that_the_server_lacks_is_named_with_those_it_has(blocks_xodr: Path) -> None:
    with loopback(blocks_xodr) as server:
        where = ["--sim", "carla", "--port", str(server.port), "--map", "Town99"]
        told = CliRunner().invoke(app, ["drive", "--from", "random", "--to", "random", *where])
    assert "no map Town99; it has blocks" in str(told.exception)


def test_a_trial_of_an_experiment_is_the_drive_with_its_options(blocks_xodr: Path, blocks_net: Path) -> None:
    with loopback(blocks_xodr) as server:
        grid = replace(GRID, maps=(str(blocks_net),), server=f"127.0.0.1:{server.port}")
        (cell,) = cells(Grid.from_json(grid.to_json()))
        assert cell.task.work == "carla"
        work = CarlaTrials()
        result = work.run(work.prepare(cell.task.shared), cell.task.arguments)
        assert result["status"] == "SUCCESS"
        server.arm(die_at=1)
        with pytest.raises(SimulatorError):
            work.run(work.prepare(cell.task.shared), cell.task.arguments)


def test_an_experiment_on_a_server_has_a_report_that_says_so_and_its_trials_can_be_looked_at(
    blocks_xodr: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    asked, out = tmp_path / "asked.yaml", tmp_path / "out"
    asked.write_text('{maps: blocks, missions: "random:1", traffic: {few: 1}, algorithms: [tmpud], seeds: 1}')
    with loopback(blocks_xodr) as server:
        where = ["--sim", "carla", "--port", str(server.port), "--out", str(out)]
        assert CliRunner().invoke(app, ["sweep", str(asked), *where]).exit_code == 0
        assert server.report()["actors"] == {}
    report = (out / "report.md").read_text()
    assert "# A sweep on a CARLA server" in report
    assert f"| server | 127.0.0.1:{server.port} |" in report
    assert "carla 0.9.16" in report
    found = read_findings(out)
    assert [(row.algorithm, row.status) for row in found.rows] == [("tmpud", "SUCCESS")]
    assert found.kind.cells
    assert [cell.task.key for cell in found.kind.cells(found.results.manifest["options"])] == ["few/00000/tmpud"]


@pytest.mark.parametrize("name", ["table1", "sweep"])
def test_each_grid_has_a_kind_of_its_own_on_a_server(name: str) -> None:
    assert "CARLA server" in KINDS[f"{name}-carla"].title
    assert KINDS[f"{name}-carla"].cells


@pytest.mark.parametrize(("status", "error"), [("SIM_CRASH", SimulatorError), ("SIM_HANG", SimulatorHangError)])
def test_a_trial_that_a_server_ends_is_a_fault_of_that_name(
    status: str, error: type[SimulatorError], monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = Finished(1.0, status, "no answer", 0.0, 1.0, 0, {"forced_stops": 0, "violations": 0})
    monkeypatch.setattr("tmpud.experiments.trials.carla.drive", lambda *_, **__: [ended])
    (cell,) = cells(replace(GRID, missions=("paper",), server="127.0.0.1:1"))
    work = CarlaTrials()
    with pytest.raises(error, match="no answer") as raised:
        work.run(work.prepare(cell.task.shared), cell.task.arguments)
    assert raised.type is error


def test_on_a_net_that_is_shifted_against_the_servers_map_all_is_where_the_net_has_it(
    blocks_net: Path, blocks_xodr: Path, tmp_path: Path
) -> None:
    shifted = tmp_path / "blocks.net.xml"
    moved = {"offset.x": "100", "offset.y": "50", "offset.disable-normalization": "true"}
    run_tool("netconvert", {"sumo-net-file": str(blocks_net), "output-file": str(shifted), **moved})
    town = load_map(shifted)
    with loopback(blocks_xodr) as server:
        at = Address(port=server.port)
        with CarlaSimulator(town, traffic=3, seed=1, server=at, warm_up=0) as simulator:
            ego = simulator.reset("a_0", 30.0).ego
            assert ego.pose == pytest.approx(town.lanes["a_0"].centre.pose_at(30.0), abs=0.1)
            assert ego.lane == "a_0"
            assert set(simulator.everyone().lanes) <= town.lanes.keys()
            places = [place[:2] for place in server.report()["vehicles"].values()]
    assert any(math.dist((x + 100, -y + 50), ego.pose[:2]) < 0.3 for x, y in places)
