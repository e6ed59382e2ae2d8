import json
import math
from pathlib import Path
from typing import Any

import pytest

from tmpud.errors import RunFileError
from tmpud.execution.abstract import COLLIDE, MERGE, STOP
from tmpud.experiments.running.tasks import DONE, ERROR, Record
from tmpud.experiments.statistics.paper_numbers import FIGURE4
from tmpud.experiments.worlds.learning import LearningRuns, tasks, to_json, world
from tmpud.experiments.worlds.models import joint_sample, read_world
from tmpud.presets import PRESETS, TMPUD, preset_named

CONDITIONS = tuple(FIGURE4)


def learnt(merges: int = 8, roads: int = 4, seed: int = 5) -> list[Record]:
    work, todo = LearningRuns(), tasks(merges, seed, roads)
    prepared = work.prepare(todo[0].shared)
    return [
        Record(key=task.key, digest=task.digest, status=DONE, result=work.run(prepared, task.arguments))
        for task in todo
    ]


@pytest.fixture(scope="module")
def records() -> list[Record]:
    return learnt()


def made(records: list[Record], time: str = "2026-01-01") -> dict[str, Any]:
    return world(records, merges=8, seed=5, command="tmpud learn-world", time=time)


def test_every_condition_has_its_merges_for_each_preset(records: list[Record], tmp_path: Path) -> None:
    file = tmp_path / "world.json"
    file.write_text(to_json(made(records)))
    learned = read_world(file)
    for condition in CONDITIONS:
        counts = {name: row["count"] for name, row in learned["conditions"][condition]["outcomes"].items()}
        assert sum(counts.values()) == 8
        for preset in PRESETS.values():
            sample = joint_sample(learned, condition, preset)
            assert {name: sample.outcome.count(name) for name in (MERGE, COLLIDE, STOP)} == counts
            assert all(0.0 <= value <= 1.0 for value in sample.safe)


def test_estimate_and_outcome_stay_together_in_the_order_of_the_chunks(records: list[Record]) -> None:
    sample = joint_sample(made(list(reversed(records))), CONDITIONS[3], TMPUD)
    chunks = [record.result for record in records if record.key.startswith(CONDITIONS[3])]
    letters = {MERGE: "m", COLLIDE: "c", STOP: "s"}
    assert list(sample.safe) == [value for chunk in chunks for value in chunk["safe"]["tmpud"]]
    assert "".join(letters[name] for name in sample.outcome) == "".join(chunk["outcome"] for chunk in chunks)


def test_learning_again_gives_the_same_but_for_when_and_how(records: list[Record]) -> None:
    first, again = made(records), made(learnt(), time="2027-01-01")
    assert first.pop("made") != again.pop("made")
    assert to_json(first) == to_json(again)


def test_the_shares_have_intervals_and_a_failed_chunk_is_missing_from_the_count(records: list[Record]) -> None:
    failed = Record(key=records[0].key, digest=records[0].digest, status=ERROR, result={"message": "broken"})
    outcomes = made([failed, *records[1:]])["conditions"][CONDITIONS[0]]["outcomes"]
    for row in outcomes.values():
        assert row["n"] == 4
        assert row["low"] <= row["value"] == row["count"] / 4 <= row["high"]
    assert math.fsum(row["value"] for row in outcomes.values()) == pytest.approx(1.0)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": "another"}'])
def test_a_file_that_is_no_learned_world_is_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "world.json"
    file.write_text(text)
    with pytest.raises(RunFileError, match=r"world\.json"):
        read_world(file)


def test_a_condition_or_preset_that_was_not_learnt_is_refused(records: list[Record]) -> None:
    learned = made(records)
    with pytest.raises(RunFileError, match="ice"):
        joint_sample(learned, "ice", TMPUD)
    with pytest.raises(RunFileError, match="samples=50"):
        joint_sample(learned, CONDITIONS[0], preset_named("paper:samples=50"))
    learned["conditions"][CONDITIONS[0]]["samples"]["outcome"] = "m"
    with pytest.raises(RunFileError, match="no samples"):
        joint_sample(learned, CONDITIONS[0], TMPUD)


def test_the_shipped_world_was_learnt_from_thousands_of_merges_and_begins_as_it_would_again() -> None:
    shipped = read_world()
    for condition in CONDITIONS:
        for preset in PRESETS.values():
            assert len(joint_sample(shipped, condition, preset).safe) >= 2000
    task = tasks(shipped["merges"], shipped["seed"])[-1]
    again = LearningRuns().run(LearningRuns().prepare(task.shared), task.arguments)
    samples = shipped["conditions"][CONDITIONS[3]]["samples"]
    assert samples["outcome"].endswith(again["outcome"])
    for preset, values in again["safe"].items():
        assert list(map(float, samples["safe"][preset].split()))[-len(values) :] == values
    json.dumps(shipped, allow_nan=False)
