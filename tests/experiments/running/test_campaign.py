from __future__ import annotations

import os
import signal
import threading
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from tests.experiments.running.works import HERE, task, tasks
from tmpud.errors import FolderError, RequestError
from tmpud.experiments.running.campaign import run_campaign
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.store import RESULTS, read_results
from tmpud.experiments.running.tasks import DONE, ERROR, SIM_CRASH, SIM_HANG, Record, Task, results_hash
from tmpud.experiments.running.workers import Limits

TRY = Experiment(name="try", options={"trials": 3})
FAULTS = {
    "crash": SIM_CRASH, "exit": SIM_CRASH, "leave": SIM_CRASH, "garbage": SIM_CRASH, "simulator": SIM_CRASH,
    "hang": SIM_HANG, "still": SIM_HANG,
    "raise": ERROR, "nan": ERROR, "set": ERROR, "no mapping": ERROR, "print": DONE,
}  # fmt: skip


def run(folder: Path, todo: list[Task], **limits: float) -> Iterator[Record]:
    return run_campaign(folder, TRY, todo, limits=Limits(**{"jobs": 2, **limits}))  # type: ignore[arg-type]


def finish(folder: Path, todo: list[Task], **limits: float) -> dict[str, Record]:
    records = list(run(folder, todo, **limits))
    assert results_hash(records) == results_hash(read_results(folder).records), "what is yielded is what is kept"
    return {record.key: record for record in records}


@pytest.mark.parametrize("isolated", [False, True])
def test_every_task_gets_the_record_of_its_arguments_and_what_is_shared(tmp_path: Path, isolated: bool) -> None:
    records = finish(tmp_path, tasks(12, isolated=isolated))
    assert {key: record.result["text"] for key, record in records.items()} == {
        f"{n:04d}": f"[{n // 5}] {n} " for n in range(12)
    }


@pytest.mark.parametrize("isolated", [False, True])
@pytest.mark.parametrize("limits", [{"jobs": 1}, {"jobs": 3}, {"recycle_after": 1}, {"recycle_after": 3}], ids=str)
def test_workers_and_their_recycling_change_no_result(
    tmp_path: Path, isolated: bool, limits: dict[str, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    todo = tasks(12, isolated=isolated)
    expected = results_hash(finish(tmp_path / "plain", todo).values())
    monkeypatch.setenv("PYTHONHASHSEED", "77")
    assert results_hash(finish(tmp_path / "other", todo[::-1], **limits).values()) == expected


@pytest.mark.parametrize("isolated", [False, True])
@pytest.mark.parametrize("how", FAULTS)
def test_what_goes_wrong_with_a_task_costs_that_task_only(tmp_path: Path, isolated: bool, how: str) -> None:
    todo = tasks(5, isolated=isolated)
    todo.insert(2, task("bad", isolated=isolated, how=how))
    records = finish(tmp_path, todo, jobs=1, task=0.5)
    assert records.pop("bad").status == FAULTS[how]
    assert {key: record.result.get("text") for key, record in records.items()} == {
        f"{n:04d}": f"[0] {n} " for n in range(5)
    }
    assert len(records) == 5


@pytest.mark.parametrize("isolated", [False, True])
@pytest.mark.parametrize("how", ["crash", "hang", "raise"])
def test_what_cannot_be_prepared_costs_the_tasks_that_share_it(tmp_path: Path, isolated: bool, how: str) -> None:
    bad = [
        Task(
            key=key, work=f"{HERE}:{'Isolated' if isolated else 'Quick'}", shared={"town": 0, "how": how}, arguments={}
        )
        for key in ("bad/1", "bad/2")
    ]
    records = finish(tmp_path, [*bad, *tasks(3, isolated=isolated)], prepare=2.0)
    assert Counter(record.status for record in records.values()) == {FAULTS[how]: 2, DONE: 3}


def test_a_fault_has_one_line_that_is_the_same_each_time(tmp_path: Path) -> None:
    records = finish(tmp_path, [task("bad", how="raise")])
    assert records["bad"].result == {"message": "ValueError: no such <object object at 0x...>"}
    assert "Traceback" in (tmp_path / "workers.log").read_text()


@pytest.mark.parametrize("isolated", [False, True])
def test_a_result_may_be_larger_than_any_pipe(tmp_path: Path, isolated: bool) -> None:
    records = finish(tmp_path, [task("big", isolated=isolated, size=3_000_000)])
    assert len(records["big"].result["text"]) > 3_000_000


def test_a_group_is_prepared_once_and_each_of_its_tasks_has_a_process(tmp_path: Path) -> None:
    records = finish(tmp_path, [task(str(n), work="WhereIsolated") for n in range(4)]).values()
    assert len({record.result["prepared_in"] for record in records}) == 1
    assert len({record.result["run_in"] for record in records}) == 4


def test_a_task_has_the_notes_of_those_before_it_that_start_from_the_same(tmp_path: Path) -> None:
    todo = [task(f"{n}", work="Noting", shared=n // 4, seed=n, how="crash" * (n == 1)) for n in range(5)]
    records = finish(tmp_path / "together", todo)
    assert records.pop("1").status == SIM_CRASH
    assert [record.result["before"] for _, record in sorted(records.items())] == [[], ["0"], ["0", "2"], []]
    alone = finish(tmp_path / "alone", todo[2:], recycle_after=1)
    assert [record.result["before"] for record in alone.values()] == [[], [], []]


def test_a_worker_is_replaced_after_its_share_of_tasks(tmp_path: Path) -> None:
    records = finish(tmp_path, [task(str(n), work="Where") for n in range(6)], jobs=1, recycle_after=2).values()
    assert set(Counter(record.result["run_in"] for record in records).values()) == {2}


@pytest.mark.parametrize(("count", "longest"), [(9, 4), (5, 4)])
def test_no_worker_does_more_tasks_than_its_share(tmp_path: Path, count: int, longest: int) -> None:
    records = finish(tmp_path, [task(str(n), work="Where") for n in range(count)], jobs=1, recycle_after=longest)
    assert max(Counter(record.result["run_in"] for record in records.values()).values()) <= longest


def test_many_tasks_that_start_from_the_same_are_dealt_out_to_all_workers(tmp_path: Path) -> None:
    records = finish(tmp_path, [task(f"{n:02}", work="Where") for n in range(70)], jobs=3, together=False)
    done_by = [records[f"{n:02}"].result["run_in"] for n in range(70)]
    assert sorted(Counter(done_by).values()) == [23, 23, 24]
    assert all(len({*done_by[n : n + 3]}) == 3 for n in range(68)), "those that stand together go to all"


def test_a_process_with_threads_is_not_copied(tmp_path: Path) -> None:
    record = finish(tmp_path, [task("threads", work="Threaded")])["threads"]
    assert (record.status, "2 threads" in record.result["message"]) == (ERROR, True)


def test_the_same_call_again_does_what_is_missing(tmp_path: Path) -> None:
    todo = [task(str(n), work="Where", seconds=0.1) for n in range(7)]
    first = list(islice(run(tmp_path, todo), 3))
    kept = read_results(tmp_path)
    assert not kept.complete
    assert {record.key for record in first} <= {record.key for record in kept.records}
    records = finish(tmp_path, todo)
    assert len(records) == 7
    assert all(records[record.key] == record for record in kept.records), "what was done is not done again"
    assert read_results(tmp_path).complete


def test_the_tasks_of_damaged_records_are_done_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    todo = tasks(6)
    expected = results_hash(finish(tmp_path, todo).values())
    lines = (tmp_path / RESULTS).read_bytes().splitlines(keepends=True)
    lines[1] = lines[1].replace(b"DONE", b"GONE")
    (tmp_path / RESULTS).write_bytes(b"".join(lines)[:-7])
    assert results_hash(run(tmp_path, todo)) == expected
    said = capsys.readouterr().err
    assert f"{tmp_path / RESULTS}:2: damaged" in said
    assert f"{tmp_path / RESULTS}:6: cut off" in said


@pytest.mark.parametrize("isolated", [False, True])
@pytest.mark.parametrize("how", ["crash", "hang", "raise"])
def test_what_ended_in_a_tool_fault_is_tried_again_once_and_nothing_else_is(
    tmp_path: Path, isolated: bool, how: str, capsys: pytest.CaptureFixture[str]
) -> None:
    healthy, folder = tmp_path / "healthy", tmp_path / "run"
    todo = [*tasks(4, isolated=isolated), task("bad", isolated=isolated, how=how, until=str(healthy))]
    assert finish(folder, todo, task=0.5)["bad"].status == FAULTS[how]
    before = (folder / RESULTS).read_bytes()
    assert "again" not in capsys.readouterr().err
    healthy.touch()
    records = finish(folder, todo)
    assert "1 of 5 tasks ended in a tool fault before; trying again" in capsys.readouterr().err
    assert results_hash(records.values()) == results_hash(finish(tmp_path / "unbroken", todo).values())
    after = (folder / RESULTS).read_bytes()
    assert after.startswith(before)
    assert (len(before.splitlines()), len(after.splitlines())) == (5, 6)
    assert results_hash(finish(folder, todo).values()) == results_hash(records.values())
    assert (folder / RESULTS).read_bytes() == after
    assert "again" not in capsys.readouterr().err


def test_a_task_that_fails_again_keeps_one_record(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first = finish(tmp_path, todo := [*tasks(2), task("bad", how="raise")])
    assert finish(tmp_path, todo) == first
    assert "trying again" in capsys.readouterr().err
    results = read_results(tmp_path)
    assert (len(results.records), results.complete, results.damages) == (3, True, ())


def test_a_fault_stays_until_its_task_has_ended_again(tmp_path: Path) -> None:
    finish(tmp_path, todo := [task("bad", how="raise"), *tasks(2)])
    before = read_results(tmp_path).records
    assert {record.key for record in islice(run(tmp_path, todo), 2)} == {"0000", "0001"}
    assert read_results(tmp_path).records == before


def test_another_experiment_is_refused_before_anything_runs(tmp_path: Path) -> None:
    finish(tmp_path, tasks(2))
    other = Experiment(name="try", options={"trials": 4})
    with pytest.raises(FolderError, match=r"option trials 3 \(now 4\); choose another folder"):
        next(run_campaign(tmp_path, other, tasks(2), limits=Limits()))
    with pytest.raises(FolderError, match="other tasks"):
        next(run(tmp_path, tasks(3)))


def test_a_second_supervisor_is_refused_until_the_first_is_done(tmp_path: Path) -> None:
    first = run(tmp_path, tasks(2))
    next(first)
    with pytest.raises(FolderError, match=f"in use by process {os.getpid()}"):
        next(run(tmp_path, tasks(2)))
    first.close()  # type: ignore[attr-defined]
    assert len(finish(tmp_path, tasks(2))) == 2


def test_tasks_that_cannot_be_told_apart_or_done_are_refused(tmp_path: Path) -> None:
    with pytest.raises(RequestError, match="2 tasks have the key '0000'"):
        next(run(tmp_path, [*tasks(1), *tasks(1)]))
    with pytest.raises(RequestError, match="no work is called 'unheard'"):
        next(run(tmp_path, [Task(key="a", work="unheard", shared={}, arguments={})]))
    unfound = finish(tmp_path, [Task(key="a", work=f"{HERE}:Unheard", shared={}, arguments={})])
    assert unfound["a"].status == ERROR


def test_no_tasks_are_done_at_once(tmp_path: Path) -> None:
    assert list(run(tmp_path, [])) == []


@pytest.fixture
def heard() -> Iterator[None]:
    """Have SIGINT heard where the shell that started the tests in the background had it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_leaves_no_worker_and_loses_nothing(tmp_path: Path, number: signal.Signals) -> None:
    todo, before = [*tasks(3), *tasks(8, seconds=30.0, group=1)[4:]], children()
    seen: list[Record] = []

    def collect() -> None:
        for record in run(tmp_path, todo):
            seen.append(record)
            if len(seen) == 3:
                threading.Timer(0.3, os.kill, (os.getpid(), number)).start()

    with pytest.raises(KeyboardInterrupt):
        collect()
    assert {record.key for record in read_results(tmp_path).records} == {record.key for record in seen}
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    assert children() <= before  # other tests may have left some


class Struck:
    """Something that an interrupt meets while it is destroyed, where Python drops what is raised."""

    def __init__(self, number: signal.Signals) -> None:
        self._number = number

    def __del__(self) -> None:
        os.kill(os.getpid(), self._number)


@pytest.mark.usefixtures("heard")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("left", [5, 0])
def test_an_interrupt_that_python_drops_is_not_lost(tmp_path: Path, number: signal.Signals, left: int) -> None:
    campaign, seen, before = run(tmp_path, tasks(6), jobs=1, recycle_after=1), list[Record](), children()

    def collect() -> None:
        for record in campaign:
            seen.append(record)
            if len(seen) == 6 - left:
                Struck(number)

    with pytest.raises(KeyboardInterrupt):
        collect()
    assert len(seen) <= 6 - left + 1
    assert children() <= before  # other tests may have left some


def children() -> set[str]:
    """Return the processes this one has started that are still there."""
    listed = Path(f"/proc/{os.getpid()}/task/{threading.main_thread().native_id}/children").read_text()
    return set(listed.split())
