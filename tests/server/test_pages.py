"""What the pages say of runs and experiments: whole, damaged, growing, with hostile names."""

from __future__ import annotations

import gzip
import json
import os
import re
import subprocess
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.server.asking import Served, Shown, served
from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import header, merging, recorded
from tmpud.events import to_json
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.store import LOCK, Store
from tmpud.experiments.running.tasks import DONE, ERROR, Record, Task
from tmpud.recording import LOG
from tmpud.server import replays

OURS = {
    "html", "head", "meta", "title", "link", "script", "body", "header", "main", "section", "div", "h1", "h2", "small",
    "p", "table", "thead", "tbody", "tr", "th", "td", "a", "bdi", "span", "progress", "code", "ul", "li", "details",
    "summary", "dl", "dt", "dd", "button", "iframe",
}  # fmt: skip
TASKS = [Task(key=f"{n}", work="full", shared={}, arguments={"n": n}) for n in range(4)]


def done(task: Task, status: str = DONE, **result: Any) -> Record:
    return Record(key=task.key, digest=task.digest, status=status, result=result)


@contextmanager
def campaign(folder: Path, **options: Any) -> Iterator[Store]:
    with Store(folder, Experiment(name="sweep", options=options, command="tmpud sweep it.yaml"), TASKS) as store:
        yield store


def file_name(name: str) -> str:
    return re.sub(r"[/\x00]", "_", name).encode(errors="replace").decode()


def hostile_folder(root: Path) -> Path:
    """Return a folder in which runs, missions, options and states have hostile names."""
    for number, name in enumerate(NAMES):
        folder = root / f"{number} {file_name(name)}"
        folder.mkdir(parents=True)
        town = {"name": name, "digest": str(number // 2)}  # two and two can be compared
        log = json.dumps(to_json(replace(header(start=name, goal=name, algorithm=name), map=town))) + "\n"
        (folder / LOG).write_bytes(gzip.compress(log.encode()))
    with campaign(root / "sweep", **dict(zip(NAMES, NAMES, strict=True))) as store:
        store.append([done(TASKS[0], NAMES[0])])
    return root


def text_of(name: str) -> str:
    """Return a name as a page can show it: HTML knows neither half surrogate pairs nor NUL."""
    return " ".join(name.encode(errors="replace").decode().replace("\x00", "").split())


def shown(server: Served, path: str) -> Shown:
    answer = server.ask(path)
    assert answer.status == 200, path
    page = Shown(answer.text.replace("\x00", ""))
    page.text = " ".join(page.text.split())
    return page


def test_a_whole_run_is_shown_with_its_replay(tmp_path: Path) -> None:
    recorded(tmp_path / "runs" / "one")
    with served(tmp_path / "runs") as server:
        link = server.link("runs/one")
        page = shown(server, link)
        assert "SUCCESS" in page.text
        assert "40 m in 4.0 s, replans: 1" in page.text
        assert "missing" not in page.attributes
        replay = server.ask(f"{link}/replay")
        assert "Content-Security-Policy" in replay.text
        assert replay.headers["Content-Security-Policy"].startswith("sandbox allow-scripts")


def test_two_thresholds_are_told_apart(tmp_path: Path) -> None:
    for beta in (0.1, 0.5):
        recorded(tmp_path / "runs" / f"b{beta}", merging(algorithm="threshold", beta=beta))
    with served(tmp_path / "runs") as server:
        text = shown(server, "").text
    assert "threshold(0.1), 2 vehicles" in text
    assert "threshold(0.5), 2 vehicles" in text


def test_a_run_can_be_seen_beside_another_on_its_map(tmp_path: Path) -> None:
    other_map = [replace(header(), map={"name": "elsewhere", "digest": "other"})]
    recorded(tmp_path / "one")
    recorded(tmp_path / "same", [header(algorithm="no-com")])
    recorded(tmp_path / "busier", [header(traffic=9)])
    recorded(tmp_path / "elsewhere", other_map)
    with served(tmp_path) as server:
        link, root = server.link(f"{tmp_path.name}/one"), tmp_path.name
        listed = re.findall(r'/with/\w+"><bdi>([^<]+)</bdi></a>.*?(\(other traffic\))?</li>', server.ask(link).text)
        assert listed == [(f"{root}/same", ""), (f"{root}/busier", "(other traffic)")]
        pair = f"{link}/with/{server.link(f'{root}/same').removeprefix('runs/')}"
        page = shown(server, pair)
        assert f"{root}/one beside {root}/same" in page.text
        assert server.ask(f"{pair}/part").status == 200
        replay = server.ask(f"{pair}/replay")
        assert (replay.status, "tmpud replay" in replay.text) == (200, True)
        assert replay.headers["Content-Security-Policy"].startswith("sandbox allow-scripts")
        stranger = server.ask(f"{link}/with/{server.link(f'{root}/elsewhere').removeprefix('runs/')}/replay")
        assert (stranger.status, "only runs on the same map" in stranger.text) == (404, True)
        assert {server.ask(f"{link}/with/{end}").status for end in ("x", "x/part", "x/replay", "", "../x")} == {404}


def test_a_damaged_run_says_what_is_missing_and_a_missing_one_is_told_as_such(tmp_path: Path) -> None:
    data = (recorded(tmp_path / "whole") / LOG).read_bytes()
    torn, spoilt = data[: len(data) // 2], data[:800] + b"\xff" * 40 + data[840:]
    for name, content in {"torn": torn, "spoilt": spoilt, "empty": b"", "letter": b"Dear all"}.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / LOG).write_bytes(content)
        os.utime(tmp_path / name / LOG, (0, 0))
    with served(tmp_path) as server:
        root = tmp_path.name
        assert "no end" in server.part(f"{root}/torn")
        assert "was broken off" in server.part(f"{root}/torn")
        assert "damaged in the log: everything after line" in server.part(f"{root}/spoilt")
        for name in ("empty", "letter"):
            assert "cannot be read" in server.part(f"{root}/{name}")
            assert 'data-shown="no"' in server.part(f"{root}/{name}")
            assert server.ask(f"{server.link(f'{root}/{name}')}/replay").status == 404
        link = server.link(f"{root}/whole")
        (tmp_path / "whole" / LOG).unlink()
        assert {server.ask(f"{link}{end}").status for end in ("", "/part", "/replay")} == {404}


def test_a_run_is_seen_growing(tmp_path: Path) -> None:
    data = (recorded(tmp_path / "made") / LOG).read_bytes()
    (tmp_path / "live" / "run").mkdir(parents=True)
    with served(tmp_path / "live") as server, (tmp_path / "live" / "run" / LOG).open("wb") as log:
        seen = []
        for part in (data[:0], data[:1400], data[1400:1700], data[1700:]):
            log.write(part)
            log.flush()
            seen.append(server.part("live/run"))
        assert len(set(seen)) == 4
        assert [re.findall(r'badge \w+"><bdi>([^<]+)', page)[0] for page in seen] == [
            "just begun", "being written", "being written", "SUCCESS",
        ]  # fmt: skip


def test_what_was_seen_is_not_sent_again(tmp_path: Path) -> None:
    recorded(tmp_path / "run")
    with served(tmp_path) as server:
        for path in ("list", f"{server.link(f'{tmp_path.name}/run')}/part"):
            seen = server.ask(path).headers["X-Seen"]
            assert (server.ask(f"{path}?seen={seen}").status, server.ask(f"{path}?seen=other").status) == (204, 200)
        page = server.ask("")
        assert f'data-seen="{server.ask("list").headers["X-Seen"]}"' in page.text


def test_a_campaign_is_followed_from_its_first_task_to_its_report(tmp_path: Path) -> None:
    folder = tmp_path / "sweep"
    name = f"{tmp_path.name}/sweep"
    with served(tmp_path) as server:
        with campaign(folder, seeds=[1, 2, 3]) as store:
            seen = [server.part(name)]
            store.append([done(TASKS[0]), done(TASKS[1], ERROR, message="it fell")])
            seen.append(server.part(name))
            assert all('badge live"' in page for page in seen)
            with subprocess.Popen(["/bin/true"]) as ended:
                ended.wait()
            (folder / LOCK).write_text(f"{ended.pid}\n")
            stopped = server.part(name)
            store.append([done(task) for task in TASKS[1:]])
        seen.append(server.part(name))
        assert [re.findall(r"<bdi>(\d of \d)</bdi>", page)[0] for page in seen] == ["0 of 4", "2 of 4", "4 of 4"]
        assert "1 task ended in a tool fault: ERROR" in seen[1]
        assert "2 tasks are not done; the same command goes on from there" in stopped
        assert "tmpud sweep it.yaml" in seen[2]
        assert "1..3" in seen[2]
        assert 'data-shown="no"' in seen[2]
        (folder / "report.html").write_text("<h1>All of it</h1>")
        assert 'data-shown="yes"' in server.part(name)
        report = server.ask(f"{server.link(name)}/report")
        assert report.text == "<h1>All of it</h1>"
        assert report.headers["Content-Security-Policy"].startswith("sandbox; default-src 'none'")


@pytest.mark.parametrize(
    "manifest", ["", "[]", "{", '{"schema": 1}', None, {"tasks": []}, {"options": 3}, {"tasks": {"count": "x"}}]
)
def test_an_experiment_with_a_damaged_manifest_says_so(tmp_path: Path, manifest: str | dict[str, Any] | None) -> None:
    with campaign(tmp_path / "sweep"):
        pass
    file = tmp_path / "sweep" / "manifest.json"
    whole = json.loads(file.read_text())
    file.unlink()
    if manifest is not None:
        file.write_text(manifest if isinstance(manifest, str) else json.dumps({**whole, **manifest}))
    with served(tmp_path) as server:
        assert "cannot be read" in server.part(f"{tmp_path.name}/sweep")


def test_hostile_names_are_text_on_every_page(tmp_path: Path) -> None:
    root = hostile_folder(tmp_path / "root")
    with served(root) as server:
        links = re.findall(r'href="((?:runs|experiments)/\w+)"', server.ask("").text)
        pages = {link: shown(server, link) for link in ["", *links]}
    assert len(links) == len(NAMES) + 1
    for page in pages.values():
        assert page.elements <= OURS
        assert not [name for name in page.attributes if name.startswith("on") or name == "srcdoc"]
    for number, name in enumerate(NAMES):
        text = text_of(name)
        called = text_of(f"root/{number} {file_name(name)}")
        telling = [link for link, page in pages.items() if called in page.text and f"millbrook: {text} →" in page.text]
        assert len(telling) == 3, name  # the list, the run's own page, and that of the run it can be seen beside
        assert any(text in page.text for link, page in pages.items() if link.startswith("experiments")), name


def test_fifty_clients_on_a_run_that_grows_are_all_answered_and_leave_it_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = (recorded(tmp_path / "made") / LOG).read_bytes()
    file = tmp_path / "live" / "run" / LOG
    file.parent.mkdir(parents=True)
    file.write_bytes(data[:1400])
    answered, made = threading.Event(), []
    make = replays._make

    async def counted(folders: replays.Folders) -> bytes:
        made.append(folders)
        return await make(folders)

    def write() -> None:
        with file.open("ab") as log:
            for at in range(1400, len(data), 50):
                log.write(data[at : at + 50])
                log.flush()
                answered.wait(0.02)
        while not answered.wait(0.02):
            os.utime(file)  # as if there were ever more

    monkeypatch.setattr(replays, "_make", counted)
    with served(tmp_path / "live") as server, ThreadPoolExecutor(50) as clients:
        link = server.link("live/run")
        writer = threading.Thread(target=write)
        writer.start()
        paths = [path for path in (f"{link}/replay", "", "list", f"{link}/part") for _ in range(50)]
        answers = list(clients.map(server.ask, paths))
        answered.set()
        writer.join()
        assert {answer.status for answer in answers} == {200}
        assert len(made) < 10  # for all, not for each
        assert "SUCCESS" in server.part("live/run")
    assert file.read_bytes() == data
