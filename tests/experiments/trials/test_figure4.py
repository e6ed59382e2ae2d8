import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tmpud.errors import RequestError, RunFileError
from tmpud.experiments.running.tasks import DONE, ERROR, Record, Task
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, FIGURE4
from tmpud.experiments.statistics.rows import TrialRow
from tmpud.experiments.trials.abstract import AbstractTrials
from tmpud.experiments.trials.figure4 import Figure4
from tmpud.experiments.worlds.models import FORMAT, preset_fields
from tmpud.presets import TMPUD

ALWAYS_SAFE = ("m", "1")
TELLING = ("cmms", "0 1 1 0.2")  # Safe tells the outcome
BLIND = ("cm", "1 1")  # ... and here it does not


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def written(samples: tuple[str, str]) -> str:
        condition = {"samples": {"outcome": samples[0], "safe": {"tmpud": samples[1]}}}
        path = tmp_path / f"{samples[0]}.json"
        world = {"format": FORMAT, "presets": {"tmpud": preset_fields(TMPUD)}}
        path.write_text(json.dumps({**world, "conditions": dict.fromkeys(FIGURE4, condition)}))
        return str(path)

    return written


def run(figure: Figure4) -> list[Record]:
    todo = figure.tasks()
    work = AbstractTrials()
    prepared = work.prepare(todo[0].shared)
    return [done(task, work.run(prepared, task.arguments)) for task in todo]


def done(task: Task, result: Mapping[str, Any]) -> Record:
    return Record(key=task.key, digest=task.digest, status=DONE, result=json.loads(json.dumps(result)))


def of(rows: list[TrialRow], algorithm: str) -> list[TrialRow]:
    return [row for row in rows if row.algorithm == algorithm]


def test_every_condition_algorithm_and_trial_is_there_once_in_its_batch(write: Any) -> None:
    figure = Figure4(trials=12, batches=3, world=write(ALWAYS_SAFE))
    rows = figure.rows(run(figure))
    keys = {(row.condition, row.algorithm, row.trial) for row in rows}
    assert len(rows) == len(keys) == 12 * len(FIGURE4) * len(ALGORITHMS)
    assert {row.batch for row in rows} == {0, 1, 2}
    assert all(row.batch == row.trial // 4 for row in rows)


def test_where_every_merge_is_safe_all_drive_the_shortest_way(write: Any) -> None:
    figure = Figure4(trials=4, batches=1, world=write(ALWAYS_SAFE))
    rows = figure.rows(run(figure))
    assert len({row.distance for row in rows}) == 1
    assert all(row.arrived and not row.unsafe for row in rows)


def test_where_safe_tells_the_outcome_a_threshold_above_it_is_never_unsafe_and_no_com_is_as_often_as_learnt(
    write: Any,
) -> None:
    figure = Figure4(trials=60, batches=1, world=write(TELLING))
    rows = figure.rows(run(figure))
    shortest = min(row.distance for row in rows if row.arrived)
    for algorithm in ("threshold(0.3)", "threshold(0.5)"):
        assert not any(row.unsafe for row in of(rows, algorithm))
        assert max(row.distance for row in of(rows, algorithm)) > shortest
    assert sum(row.unsafe for row in of(rows, "tmpud")) < sum(row.unsafe for row in of(rows, "no-com")) / 5
    no_com = of(rows, "no-com")
    assert all(row.distance == shortest for row in no_com if row.arrived)
    assert 0.3 < sum(row.unsafe for row in no_com) / len(no_com) < 0.7
    assert any(row.details["forced_stops"] for row in no_com)


def test_where_safe_tells_nothing_all_fare_the_same_trial_by_trial(write: Any) -> None:
    figure = Figure4(trials=40, batches=1, world=write(BLIND))
    ends = [[(row.status, row.distance) for row in of(figure.rows(run(figure)), name)] for name in ALGORITHMS]
    assert all(row == ends[0] for row in ends)
    assert {status for status, _ in ends[0]} == {"SUCCESS", "COLLISION"}


def test_a_task_gives_the_same_whatever_ran_before(write: Any) -> None:
    figure = Figure4(trials=30, batches=1, missions="random:3", world=write(TELLING))
    todo, work = figure.tasks(), AbstractTrials()
    prepared = work.prepare(todo[0].shared)
    before = {task.key: work.run(prepared, task.arguments) for task in reversed(todo)}
    for task in todo[:: len(todo) // 4]:
        assert work.run(work.prepare(task.shared), task.arguments) == before[task.key]


def test_some_plans_are_proved_again_and_agree(write: Any) -> None:
    figure = Figure4(trials=60, batches=1, missions="random:4", world=write(TELLING))
    plans = [record.result["plans"] for record in run(figure)]
    assert sum(row["mismatches"] for row in plans) == 0
    assert 0 < sum(row["proved"] for row in plans) < sum(row["made"] for row in plans) / 20


def test_a_fault_stands_in_every_row_of_its_task(write: Any) -> None:
    figure = Figure4(trials=4, batches=1, world=write(ALWAYS_SAFE))
    task = figure.tasks()[0]
    rows = figure.rows([Record(key=task.key, digest=task.digest, status=ERROR, result={"message": "broken"})])
    assert [(row.status, row.unsafe) for row in rows] == [(ERROR, False)] * 4


def test_another_learned_world_preset_or_seed_makes_other_tasks(write: Any) -> None:
    figure = Figure4(trials=4, batches=1, world=write(ALWAYS_SAFE))
    others = [replace(figure, world=write(BLIND)), replace(figure, preset="paper"), replace(figure, seed=1)]
    digests = {each.tasks()[0].digest for each in (figure, *others)}
    assert len(digests) == 4


@pytest.mark.parametrize("wrong", [{"trials": 10, "batches": 3}, {"missions": "random:0"}, {"missions": "any"}])
def test_what_cannot_be_run_is_refused(wrong: dict[str, Any], write: Any) -> None:
    with pytest.raises(RequestError):
        Figure4(world=write(ALWAYS_SAFE), **wrong).tasks()


def test_a_preset_whose_estimates_were_not_learned_is_refused(write: Any) -> None:
    (task, *_) = Figure4(trials=4, batches=1, world=write(BLIND), preset="tmpud:safety_distance=12").tasks()
    with pytest.raises(RunFileError, match="no samples"):
        AbstractTrials().prepare(task.shared)
