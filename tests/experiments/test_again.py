"""A trial is driven again as it was, and what differs from what was kept is told."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from tests.experiments.made_results import GRID, made_results, result
from tmpud.errors import RequestError
from tmpud.events import Event, Finished
from tmpud.experiments.again import caveats, differences, drive_again, mission_of, trial_of
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.store import read_results
from tmpud.experiments.running.tasks import SIM_CRASH, Record
from tmpud.experiments.running.workers import Limits
from tmpud.experiments.trials.figure4 import Figure4
from tmpud.experiments.trials.full import summary
from tmpud.experiments.trials.grid import Grid, Route, cells
from tmpud.recording import read_run
from tmpud.runner import Mission

LOG: list[Event] = [
    Finished(20.0, "SUCCESS", "", 123.4567, 20.0, 0, {"collisions": 0, "forced_stops": 0, "violations": 0})
]


def test_what_the_campaign_kept_is_what_comes_again_and_all_of_it_can_be_seen(tmp_path: Path) -> None:
    grid = replace(GRID, traffic={"few": 3}, algorithms=("tmpud",), seeds=(1,))
    experiment = Experiment(name="sweep", options=grid.to_json())
    for _ in run_campaign(tmp_path / "sweep", experiment, [c.task for c in cells(grid)], limits=Limits(jobs=1)):
        pass
    results = read_results(tmp_path / "sweep")
    trial = trial_of(results, "few/00000/tmpud")
    events = list(drive_again(trial, tmp_path / "run"))
    assert trial.record.result["status"] == "SUCCESS"
    assert differences(trial, events) == []
    assert sum(1 for _ in read_run(tmp_path / "run")) == len(events) > 100
    assert caveats(results) == []


def test_a_trials_mission_is_what_its_task_drives() -> None:
    grid = Grid(missions=(Route("park1e_0", "high4n", ("park2e_1",)),), algorithms=("threshold(0.1)",), seeds=(7,))
    assert mission_of(cells(grid)[0].task) == Mission(
        map="millbrook", start="park1e_0", goal="high4n", via=("park2e_1",), algorithm="threshold", beta=0.1,
        traffic=120, seed=7,
    )  # fmt: skip


def test_a_trial_on_a_carla_server_is_not_driven_again_but_the_command_that_does_is_told(tmp_path: Path) -> None:
    grid = Grid(
        missions=(Route("park1e_0", "high4n", ("park2e_1",)),), algorithms=("threshold(0.1)",), seeds=(7,),
        traffic={"few": 3}, server="10.0.0.7:2000",
    )  # fmt: skip
    folder = made_results(tmp_path / "sweep", grid)
    with pytest.raises(RequestError, match=r"driven on the CARLA server 10\.0\.0\.7:2000") as told:
        trial_of(read_results(folder), "few/00000/threshold(0.1)")
    words = shlex.split(str(told.value).partition(": ")[2])
    assert words[:2] == ["tmpud", "drive"]
    given = dict(word.removeprefix("--").split("=") for word in words[2:])
    assert given == {
        "sim": "carla", "host": "10.0.0.7", "port": "2000", "map": "millbrook", "from": "park1e_0", "to": "high4n",
        "via": "park2e_1", "traffic": "3", "seed": "7", "preset": "tmpud", "algorithm": "threshold", "beta": "0.1",
    }  # fmt: skip


def test_each_difference_is_named_with_both_values(tmp_path: Path) -> None:
    trial = trial_of(read_results(made_results(tmp_path / "sweep")), "normal/00001/no-com")
    told = differences(trial, LOG)
    assert "status: COLLISION was kept, SUCCESS came now" in told
    assert "distance: 101.0 was kept, 123.457 came now" in told
    assert len(told) == 4  # unsafe and collisions, too
    same = made_results(tmp_path / "same", make=lambda _: summary(LOG))
    assert differences(trial_of(read_results(same), "normal/00001/no-com"), LOG) == []


def test_a_trial_that_ended_in_a_tool_fault_has_nothing_to_compare_with(tmp_path: Path) -> None:
    folder = made_results(tmp_path / "sweep", make=lambda _: {"message": "gone"}, status=SIM_CRASH)
    (line,) = differences(trial_of(read_results(folder), "normal/00001/no-com"), LOG)
    assert SIM_CRASH in line


def test_a_trial_is_told_from_others_and_from_itself_under_other_code_or_on_another_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    results = read_results(made_results(tmp_path / "sweep"))
    trials = [trial_of(results, record.key) for record in results.records]
    assert len({trial.stamp for trial in trials}) == len(trials)
    first = trials[0]
    changed = replace(first, record=replace(first.record, result={**first.record.result, "distance": 1.0}))
    assert changed.stamp != first.stamp
    before = first.stamp
    monkeypatch.setattr("tmpud.experiments.again.code_digest", lambda: "other")
    assert first.stamp != before
    assert "by other code of tmpud" in caveats(results)[0]


def test_no_such_trial_and_one_that_saw_no_traffic_are_refused(tmp_path: Path) -> None:
    results = read_results(made_results(tmp_path / "sweep"))
    for key in ("", "normal/00009/tmpud", "../normal/00001/tmpud"):
        with pytest.raises(RequestError, match="one is called normal/00000/tmpud"):
            trial_of(results, key)
    stale = Record(key="normal/00001/tmpud", digest="another", status="DONE", result=result(cells(GRID)[0]))
    with pytest.raises(RequestError, match="no trial"):
        trial_of(replace(results, records=(stale,)), stale.key)
    abstract = {**results.manifest, "experiment": "figure4", "options": Figure4().to_json()}
    with pytest.raises(RequestError, match="not driven in traffic"):
        trial_of(replace(results, manifest=abstract), "x")
