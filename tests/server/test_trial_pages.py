"""From an experiment's picture to its trials, and from a trial to its replay."""

from __future__ import annotations

import re
import time
from dataclasses import replace
from pathlib import Path

import pytest

from tests.experiments.made_results import GRID, made_results, result
from tests.server.asking import Served, served
from tests.server.test_pages import OURS, shown, text_of
from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import header, recorded
from tmpud.experiments.again import drive_again, trial_of
from tmpud.experiments.kinds import findings
from tmpud.experiments.running.manifest import Experiment
from tmpud.experiments.running.store import Store, read_results
from tmpud.experiments.running.tasks import DONE, SIM_CRASH, Record
from tmpud.experiments.trials.figure4 import Figure4
from tmpud.experiments.trials.full import summary
from tmpud.experiments.trials.grid import Grid, Route

DRAWN = {"figure", "figcaption", "svg", "g", "path", "text", "circle", "br", "nav", "b"}
SHORT = replace(GRID, traffic={"few": 3}, algorithms=("tmpud",), seeds=(1,))


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "tmpud" / "trials"


def points(server: Served, name: str) -> str:
    return server.ask(f"{server.link(name)}/points").text


def trials_of(page: str) -> list[int]:
    return [int(number) for number in re.findall(r'href="\.\./trials/\w+">(\d+):', page)]


def test_every_point_leads_to_its_trials_unsafe_first(tmp_path: Path) -> None:
    folder = made_results(tmp_path / "sweep")
    cells = findings(read_results(folder)).analysis.cells
    with served(tmp_path) as server:
        link = server.link(f"{tmp_path.name}/sweep")
        picture = server.ask(f"{link}/points").text
        linked = re.findall(r'<a href="\w+/points/(\d+)"><title>([^<]+)', picture)
        for number, cell in enumerate(cells):
            page = shown(server, f"{link}/points/{number}").text
            assert f"{cell.trials} trials, of these {cell.unsafe} unsafe, {cell.arrived} arrived" in page
            assert cell.condition in page
            (words,) = [words for at, words in linked if at == str(number)]
            assert f"{cell.distance.value:.1f} m on average, {cell.per_1000.value:.1f} unsafe" in words
        worst = next(number for number, cell in enumerate(cells) if cell.unsafe)
        assert trials_of(server.ask(f"{link}/points/{worst}").text) == [1, 3, 0, 2, 4]
        assert "1 × merge collision" in shown(server, f"{link}/points/{worst}").text


def test_trials_can_be_sorted_and_chosen_and_nonsense_is_the_usual(tmp_path: Path) -> None:
    made_results(tmp_path / "sweep")
    with served(tmp_path) as server:
        link = f"{server.link(f'{tmp_path.name}/sweep')}/points/1"
        for query, expected in {
            "sort=trial": [0, 1, 2, 3, 4], "sort=longest+first": [4, 3, 2, 1, 0], "show=unsafe": [1, 3],
            "show=not+arrived&sort=shortest+first": [1, 3], "sort=status": [1, 3, 0, 2, 4],
            "sort=../x&show=%00&page=-1": [1, 3, 0, 2, 4], "page=999": [1, 3, 0, 2, 4], "page=0": [1, 3, 0, 2, 4],
        }.items():  # fmt: skip
            assert trials_of(server.ask(f"{link}?{query}").text) == expected, query


def test_a_long_list_has_pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tmpud.server.trial_pages.MOST", 2)
    made_results(tmp_path / "sweep")
    with served(tmp_path) as server:
        link = f"{server.link(f'{tmp_path.name}/sweep')}/points/1"
        assert [trials_of(server.ask(f"{link}?page={page}").text) for page in (1, 2, 3)] == [[1, 3], [0, 2], [4]]


def driven(server: Served, link: str) -> str:
    """Return what a trial's page says once it was driven again."""
    while 'role="status"' in (part := server.ask(f"{link}/part").text):
        time.sleep(0.1)
    return " ".join(part.split())


def test_a_trial_is_driven_again_once_and_what_differs_is_said(tmp_path: Path, cache: Path) -> None:
    sweep = made_results(tmp_path / "sweeps" / "one", SHORT)
    before = {file: file.read_bytes() for file in sweep.iterdir()}
    logs = set()
    for _ in range(2):
        with served(tmp_path / "sweeps") as server:
            link = server.link("sweeps/one")
            trial = f"{link}/trials/" + re.findall(r"\.\./trials/(\w+)", server.ask(f"{link}/points/0").text)[0]
            assert server.ask(f"{trial}/replay").status == 404
            part = driven(server, trial)
            assert "<b>not the same</b>" in part
            assert re.search(r"distance: 110.0 was kept, \d+", part)
            replay = server.ask(f"{trial}/replay")
            assert (replay.status, "tmpud replay" in replay.text) == (200, True)
            assert replay.headers["Content-Security-Policy"].startswith("sandbox allow-scripts")
            (folder,) = cache.iterdir()
            logs.add((folder / "run.jsonl.gz").stat().st_mtime_ns)
    assert len(logs) == 1  # the second server found it in the cache
    assert {file: file.read_bytes() for file in sweep.iterdir()} == before


def test_a_trial_can_be_seen_beside_the_same_one_by_another_algorithm(tmp_path: Path) -> None:
    made_results(tmp_path / "sweep", replace(SHORT, algorithms=("tmpud", "no-com")))
    with served(tmp_path) as server:
        link = server.link(f"{tmp_path.name}/sweep")
        row = re.findall(r"\.\./trials/(\w+)", server.ask(f"{link}/points/0").text)[0]
        (other,) = re.findall(rf'"{row}/with/(\w+)"', server.ask(f"{link}/trials/{row}").text)
        pair = f"{link}/trials/{row}/with/{other}"
        assert "beside" in shown(server, pair).text
        assert server.ask(f"{pair}/replay").status == 404
        while 'data-shown="no"' in (part := server.ask(f"{pair}/part").text):
            assert "driven again" in part
            time.sleep(0.1)
        assert part.count("driven again, it is not the same as what was kept") == 2
        replay = server.ask(f"{pair}/replay")
        assert (replay.status, "tmpud replay" in replay.text) == (200, True)
        assert server.ask(f"{link}/trials/{row}/with/x").status == 404


def test_a_trial_that_comes_out_as_it_was_kept_is_the_same(tmp_path: Path) -> None:
    trial = trial_of(read_results(made_results(tmp_path / "first", SHORT)), "few/00000/tmpud")
    kept = summary(drive_again(trial, tmp_path / "run"))
    made_results(tmp_path / "sweeps" / "one", SHORT, lambda _: kept)
    with served(tmp_path / "sweeps") as server:
        link = server.link("sweeps/one")
        row = re.findall(r"\.\./trials/(\w+)", server.ask(f"{link}/points/0").text)[0]
        part = driven(server, f"{link}/trials/{row}")
        assert "unsafe moments and all else that was kept of it are the same" in part
        assert "not the same" not in part


def test_abstract_trials_are_listed_and_have_no_replay(tmp_path: Path) -> None:
    figure = Figure4(trials=4, batches=2)
    tasks = figure.tasks()
    with Store(tmp_path / "figure", Experiment(name="figure4", options=figure.to_json()), tasks) as store:
        ends = {"status": ["SUCCESS"] * 2, "distance": [400.0, 410.0], "collisions": [0, 1], "stops": [0, 0]}
        store.append(Record(key=t.key, digest=t.digest, status=DONE, result={**ends, "plans": {}}) for t in tasks)
    with served(tmp_path) as server:
        link = server.link(f"{tmp_path.name}/figure")
        page = server.ask(f"{link}/points/0")
        assert "no traffic that a replay could show" in page.text
        assert trials_of(page.text) == []
        assert "Seed" not in page.text
        assert page.text.count("1 × merge collision") == 2
        assert "the paper&#39;s TMPUD" in points(server, f"{tmp_path.name}/figure")


def test_what_is_no_experiment_of_trials_has_no_picture_and_a_damaged_one_says_so(tmp_path: Path) -> None:
    made_results(tmp_path / "damaged")
    for name, options in {"calibration": {}, "sweep": {"maps": 3}}.items():
        with Store(tmp_path / name, Experiment(name=name, options=options), []):
            pass
    (tmp_path / "damaged" / "manifest.json").write_text("{")
    with served(tmp_path) as server:
        assert points(server, f"{tmp_path.name}/calibration") == ""
        for name in ("sweep", "damaged"):
            assert 'class="missing"' in points(server, f"{tmp_path.name}/{name}")
        assert server.ask(f"{server.link(f'{tmp_path.name}/calibration')}/points/0").status == 404


def test_what_is_not_there_is_not_found(tmp_path: Path) -> None:
    made_results(tmp_path / "sweep")
    recorded(tmp_path / "run", [header()])
    with served(tmp_path) as server:
        link, run = server.link(f"{tmp_path.name}/sweep"), server.link(f"{tmp_path.name}/run")
        for path in (
            f"{link}/points/4", f"{link}/points/-1", f"{link}/points/x", f"{link}/points/%C2%B2", f"{link}/trials/x",
            f"{link}/trials/x/part", f"{link}/trials/x/replay", f"{link}/trials/", f"{link}/trials",
            "experiments/x/points", f"{run}/points", f"{run.replace('runs', 'experiments')}/points/0",
            f"{link}/points/{'9' * 99}",
        ):  # fmt: skip
            assert server.ask(path).status == 404, path


def test_a_growing_sweep_is_counted_anew(tmp_path: Path) -> None:
    folder = made_results(tmp_path / "sweep")
    lines = (folder / "results.jsonl").read_bytes().splitlines(keepends=True)
    (folder / "results.jsonl").write_bytes(b"".join(lines[:4]))
    with served(tmp_path) as server:
        seen = [points(server, f"{tmp_path.name}/sweep")]
        part = server.part(f"{tmp_path.name}/sweep")
        (folder / "results.jsonl").write_bytes(b"".join(lines))
        seen.append(points(server, f"{tmp_path.name}/sweep"))
        assert [page.count("0 unsafe of 5") for page in seen] == [0, 2]
        assert re.findall('data-version="[^"]*"', part) != re.findall(
            'data-version="[^"]*"', server.part(f"{tmp_path.name}/sweep")
        )


def test_hostile_names_are_text_on_every_page_of_results(tmp_path: Path) -> None:
    conditions = tuple(name for name in NAMES if "\ud83d" not in name)  # JSON of a manifest has whole letters
    grid = Grid(
        missions=(Route("park1e_0", "park2e_1"),),
        traffic=dict.fromkeys(conditions, 3),
        algorithms=("tmpud",),
        seeds=(1,),
    )
    made_results(
        tmp_path / "sweep",
        grid,
        lambda cell: {**result(cell), "status": cell.condition, "message": cell.condition, cell.condition: 1},
    )
    with served(tmp_path) as server:
        link = server.link(f"{tmp_path.name}/sweep")
        pages = [shown(server, f"{link}/points")]
        numbers = range(len(conditions))
        pages += [shown(server, f"{link}/points/{number}") for number in numbers]
        trial = re.findall(r"\.\./trials/(\w+)", server.ask(f"{link}/points/0").text)[0]
        assert "<b>not the same</b>" in driven(server, f"{link}/trials/{trial}")
        pages.append(shown(server, f"{link}/trials/{trial}"))
        told = " ".join(page.text for page in pages[1:-1])
    for page in pages:
        assert page.elements <= OURS | DRAWN
        assert not [name for name in page.attributes if name.startswith("on") or name in ("srcdoc", "style")]
    for name in conditions:
        assert text_of(name) in pages[0].text
        assert told.count(text_of(name)) >= 2  # condition and status


def test_trials_that_ended_in_a_tool_fault_are_counted_apart(tmp_path: Path) -> None:
    made_results(tmp_path / "sweep", make=lambda _: {"message": "it fell"}, status=SIM_CRASH)
    with served(tmp_path) as server:
        page = shown(server, f"{server.link(f'{tmp_path.name}/sweep')}/points/0").text
        assert "5 ended in a tool fault" in page
        assert page.count(SIM_CRASH) == 5
        assert "has no point" in points(server, f"{tmp_path.name}/sweep")
