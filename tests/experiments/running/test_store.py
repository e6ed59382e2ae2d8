from __future__ import annotations

import errno
import json
import os
from dataclasses import replace
from pathlib import Path

import grimp
import pytest

import tmpud
from tests.experiments.running.works import tasks
from tmpud.errors import FolderError, RunFileError
from tmpud.experiments.running import store
from tmpud.experiments.running.manifest import MANIFEST, SHOWS_ONLY, Experiment, code_digest
from tmpud.experiments.running.store import RESULTS, TIMING, Store, provenance, read_results
from tmpud.experiments.running.tasks import DONE, SIM_CRASH, WORK, Record

TRY = Experiment(name="try", options={"trials": 3, "beta": [0.1, 0.3]}, command="tmpud try --jobs 2")
TASKS = tasks(3)
RECORDS = [Record(key=task.key, digest=task.digest, status=DONE, result={}) for task in TASKS]


def test_what_was_appended_is_there_for_the_next(tmp_path: Path) -> None:
    with Store(tmp_path / "new" / "folder", TRY, TASKS) as first:
        first.append(RECORDS[:1])
        first.append(RECORDS[1:2])
        assert not read_results(tmp_path / "new" / "folder").complete
    with Store(tmp_path / "new" / "folder", TRY, TASKS) as second:
        assert list(second.records.values()) == RECORDS[:2]
        second.append(RECORDS[2:])
    results = read_results(tmp_path / "new" / "folder")
    assert (results.records, results.complete, results.damages) == (tuple(RECORDS), True, ())


def test_each_append_is_on_disk_before_it_returns(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Store(tmp_path, TRY, TASKS) as open_store:
        synced: list[int] = []
        monkeypatch.setattr(os, "fsync", lambda _: synced.append((tmp_path / RESULTS).stat().st_size))
        open_store.append(RECORDS)
        assert synced == [(tmp_path / RESULTS).stat().st_size]


@pytest.mark.parametrize("fails", ["_write", "fsync"])
def test_a_full_disk_keeps_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: str) -> None:
    def full(descriptor: int, data: bytes = b"") -> None:
        os.write(descriptor, data[:20])
        raise OSError(errno.ENOSPC, "No space left on device")

    with Store(tmp_path, TRY, TASKS) as open_store:
        open_store.append(RECORDS[:1])
        before = (tmp_path / RESULTS).read_bytes()
        monkeypatch.setattr(store if fails == "_write" else os, fails, full)
        with pytest.raises(FolderError, match=f"{RESULTS}: cannot be written .No space left on device"):
            open_store.append(RECORDS[1:])
        assert (tmp_path / RESULTS).read_bytes() == before


def test_a_folder_that_cannot_be_one_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(FolderError, match="file: File exists"):
        Store(tmp_path / "file", TRY, TASKS)
    Store(tmp_path / "other", TRY, TASKS).close()
    (tmp_path / "other" / RESULTS).unlink()
    (tmp_path / "other" / RESULTS).mkdir()
    with pytest.raises(FolderError, match=f"{RESULTS}: Is a directory"):
        Store(tmp_path / "other", TRY, TASKS)


def test_the_lock_of_a_refused_folder_is_let_go(tmp_path: Path) -> None:
    Store(tmp_path, TRY, TASKS).close()
    for _ in range(2):
        with pytest.raises(FolderError, match="other tasks"):
            Store(tmp_path, TRY, TASKS[:2])


@pytest.mark.parametrize(
    ("experiment", "says"),
    [
        (Experiment(name="other", options=TRY.options), "holds results of 'try', not of 'other'"),
        (Experiment(name="try", options={"trials": 3}), r"begun with option beta \[0.1, 0.3\] \(now None\)"),
    ],
)
def test_other_options_are_named(tmp_path: Path, experiment: Experiment, says: str) -> None:
    Store(tmp_path, TRY, TASKS).close()
    with pytest.raises(FolderError, match=says):
        Store(tmp_path, experiment, TASKS)


@pytest.mark.parametrize(("part", "says"), [("code", "other code of tmpud"), ("versions", "clingo '1.0'")])
def test_other_code_is_named(tmp_path: Path, part: str, says: str) -> None:
    Store(tmp_path, TRY, TASKS).close()
    written = json.loads((tmp_path / MANIFEST).read_text())
    written[part] = written["versions"] | {"clingo": "1.0"} if part == "versions" else "0"
    (tmp_path / MANIFEST).write_text(json.dumps(written))
    with pytest.raises(FolderError, match=says):
        Store(tmp_path, TRY, TASKS)


def test_the_command_and_the_time_may_differ(tmp_path: Path) -> None:
    Store(tmp_path, TRY, TASKS).close()
    begun = read_results(tmp_path).manifest
    Store(tmp_path, Experiment(name="try", options=TRY.options, command="again --jobs 7"), TASKS).close()
    assert read_results(tmp_path).manifest == begun
    assert begun["command"] == "tmpud try --jobs 2"


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b'{"schema": 0}', b'{"schema": 1}', b"\xff"])
def test_a_damaged_manifest_is_refused(tmp_path: Path, content: bytes) -> None:
    Store(tmp_path, TRY, TASKS).close()
    (tmp_path / MANIFEST).write_bytes(content)
    for use in (lambda: read_results(tmp_path), lambda: Store(tmp_path, TRY, TASKS)):
        with pytest.raises(RunFileError, match=MANIFEST):
            use()


def test_results_without_a_manifest_are_not_taken_for_ones_own(tmp_path: Path) -> None:
    Store(tmp_path, TRY, TASKS).close()
    (tmp_path / MANIFEST).unlink()
    with pytest.raises(RunFileError, match=f"there is no {MANIFEST}"):
        Store(tmp_path, TRY, TASKS)


def test_there_are_no_results_where_there_is_nothing(tmp_path: Path) -> None:
    with pytest.raises(RunFileError, match="no results"):
        read_results(tmp_path / "none")


def test_a_report_says_how_many_tasks_ended_in_a_tool_fault(tmp_path: Path) -> None:
    crashed = replace(RECORDS[1], status=SIM_CRASH)
    with Store(tmp_path, TRY, TASKS) as open_store:
        open_store.append([RECORDS[0], crashed])
    assert provenance(read_results(tmp_path))["tasks"].startswith("1 of 3 done, 1 SIM_CRASH (digest ")


def test_wall_clock_times_are_beside_the_results(tmp_path: Path) -> None:
    with Store(tmp_path, TRY, TASKS) as open_store:
        open_store.note([{"key": "0000", "seconds": 1.5}])
        assert json.loads((tmp_path / TIMING).read_text()) == {"key": "0000", "seconds": 1.5}
        assert (tmp_path / RESULTS).read_bytes() == b""


def test_no_work_depends_on_what_is_left_out_of_the_code() -> None:
    graph = grimp.build_graph("tmpud")
    left_out = tuple(f"tmpud.{name}".removesuffix(".py").replace("/", ".").rstrip(".") for name in SHOWS_ONLY)
    for work in (*WORK.values(), "tmpud.experiments.running.worker:main"):
        behind = graph.find_upstream_modules(work.partition(":")[0])
        assert behind, work
        assert not [module for module in behind if module.startswith(left_out)], work


def test_the_code_is_all_but_what_shows_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tmpud, "__file__", str(tmp_path / "__init__.py"))
    (tmp_path / "viewer").mkdir()
    digests = []
    for name in ("driving.lp", "viewer/page.py"):
        (tmp_path / name).write_text("new")
        digests.append(code_digest())
    (tmp_path / "driving.lp").write_text("newer")
    assert digests[0] == digests[1] != code_digest()
