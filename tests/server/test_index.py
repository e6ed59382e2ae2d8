"""What is found, and what is not: links lead out of the folder."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.server.asking import served
from tests.viewer.made_runs import header, recorded
from tmpud.recording import LOG
from tmpud.server import index
from tmpud.server.index import EXPERIMENT, RUN, Entry, Index


def experiment(folder: Path) -> Path:
    folder.mkdir(parents=True)
    for name in ("results.jsonl", "manifest.json", "report.html"):
        (folder / name).write_text("{}")
    return folder


def names(root: Path) -> set[str]:
    return {entry.name for entry in Index([root]).entries()}


def get(found: Index, entry: Entry) -> Entry | None:
    return found.get(entry.kind, entry.id)


def test_runs_and_experiments_are_found_at_every_depth_but_not_in_hidden_folders(tmp_path: Path) -> None:
    root = tmp_path / "all"
    for name in ("one", "a/b/two", ".hidden/three", "/".join("abcdefgh")):
        recorded(root / name, [header()])
    experiment(root / "sweeps" / "four")
    assert names(root) == {"all/one", "all/a/b/two", "all/sweeps/four"}
    assert {entry.kind for entry in Index([root]).entries()} == {RUN, EXPERIMENT}
    assert names(root / "one") == {"one"}


def test_an_entry_is_found_by_its_own_number_alone(tmp_path: Path) -> None:
    recorded(tmp_path / "one", [header()])
    experiment(tmp_path / "two")
    found = Index([tmp_path])
    for entry in found.entries():
        assert get(found, entry) == entry
        other = RUN if entry.kind == EXPERIMENT else EXPERIMENT
        assert found.get(other, entry.id) is None
        assert found.get(entry.kind, entry.name) is None
        assert found.get(entry.kind, str(entry.folder)) is None


def test_links_and_pipes_are_not_followed(tmp_path: Path) -> None:
    root, outside = tmp_path / "root", tmp_path / "outside"
    recorded(outside / "run", [header()])
    experiment(outside / "experiment")
    for name in ("log", "results", "manifest", "pipe"):
        (root / name).mkdir(parents=True)
    (root / "folder").symlink_to(outside)
    (root / "log" / LOG).symlink_to(outside / "run" / LOG)
    (root / "results" / "results.jsonl").symlink_to(outside / "experiment" / "results.jsonl")
    (root / "manifest" / "results.jsonl").write_text("")
    (root / "manifest" / "manifest.json").symlink_to(outside / "experiment" / "manifest.json")
    os.mkfifo(root / "pipe" / LOG)
    assert names(root) == set()


def test_what_became_a_link_since_it_was_found_is_not_shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(index, "KEPT", 1e9)
    outside = recorded(tmp_path / "outside" / "run", [header()])
    for name in ("folder", "log", "gone"):
        recorded(tmp_path / "root" / name, [header()])
    found = Index([tmp_path / "root"])
    entries = {entry.folder.name: entry for entry in found.entries()}
    assert all(get(found, entry) for entry in entries.values())
    (tmp_path / "root" / "folder").rename(tmp_path / "moved")
    (tmp_path / "root" / "folder").symlink_to(outside)
    (tmp_path / "root" / "log" / LOG).unlink()
    (tmp_path / "root" / "log" / LOG).symlink_to(outside / LOG)
    (tmp_path / "root" / "gone" / LOG).unlink()
    assert [get(found, entry) for entry in entries.values()] == [None] * 3


def test_a_report_that_is_a_link_is_not_shown(tmp_path: Path) -> None:
    folder = experiment(tmp_path / "root" / "sweep")
    (tmp_path / "secret.html").write_text("secret")
    with served(tmp_path / "root") as server:
        link = f"{server.link('root/sweep')}/report"
        assert server.ask(link).text == "{}"
        (folder / "report.html").unlink()
        (folder / "report.html").symlink_to(tmp_path / "secret.html")
        answer = server.ask(link)
        assert (answer.status, "secret" in answer.text) == (404, False)
