from __future__ import annotations

import json
import random
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from benchmarks.__main__ import main
from benchmarks.harness import DisagreementError, race
from benchmarks.peers import asp, routers, scalar_safety
from benchmarks.peers.compiled import Compiled
from benchmarks.plan import REPLAN, replan
from benchmarks.questions import draw, graph_of
from tests.task.tiny_roads import grid
from tests.viewer.made_runs import recorded
from tmpud.presets import Preset
from tmpud.roads import load_map
from tmpud.task.asp_planner import AspPlanner

TINY = {
    "plan": ("--maps", "millbrook", "grid:3:1", "--pairs", "2"),
    "load": ("--maps", "millbrook", "--rounds", "1"),
    "safety": ("--vehicles", "1", "3", "--samples", "30", "--rounds", "3", "--instants", "4"),
    "start": ("--rounds", "1"),
    "full_step": ("--vehicles", "3", "--steps", "250", "--rounds", "1"),
    "trials": ("--seeds", "1", "--traffic", "3"),
    "abstract": ("--trials", "5", "--rounds", "2"),
    "carla": ("--vehicles", "3", "--steps", "5", "--rounds", "1"),
    "view": ("--rounds", "1", "--clients", "3", "--traffic", "3", "--goal", "park2e_1"),
}


@pytest.mark.parametrize("name", TINY)
def test_a_benchmark_runs_and_writes_what_it_prints(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if name == "carla":
        pytest.importorskip("carla")
    assert main([name, *TINY[name], "--json", str(tmp_path / "found.json")]) == 0
    printed = capsys.readouterr().out
    found = json.loads((tmp_path / "found.json").read_text())
    for result in found["results"]:
        assert result["title"] in printed
        assert result["base"] in result["entries"]
        for entry, row in result["entries"].items():
            assert entry in printed
            assert len(row["each_s"]) == result["n"]
            assert row["median_s"] > 0


def test_highway_env_is_skipped_with_a_line_or_takes_part(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["highway", "--vehicles", "3", "--steps", "250", "--rounds", "1"]) == 0
    (line,) = [line for line in capsys.readouterr().out.splitlines() if line.startswith("highway-env")]
    assert "ms" in line or "skipped" in line


def test_frames_are_timed_or_skipped_where_there_is_no_browser(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = recorded(tmp_path / "run")
    assert main(["frames", "--run", str(run), "--frames", "5", "--rounds", "2"]) == 0
    printed = capsys.readouterr().out
    assert "skipped" in printed or ("(n = 10, wall clock)" in printed and "2 vehicles" in printed)


def test_growth_is_drawn(tmp_path: Path) -> None:
    few = ("--maps", "grid:3:1", "grid:4:1", "--pairs", "2", "--rounds", "1", "--sizes", "1", "2", "--samples", "10")
    assert main(["growth", *few, "--out", str(tmp_path)]) == 0
    drawn = (tmp_path / "growth.svg").read_text()
    for label in (REPLAN, "lanes of the map", "vehicles", "samples"):
        assert label in drawn


def wrong(shortest: Any) -> Any:
    return lambda router, start, goal: shortest(router, start, goal) + 1


def test_no_time_is_printed_where_a_planner_is_wrong(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(routers.Networkx, "shortest", wrong(routers.Networkx.shortest))
    assert main(["plan", "--maps", "grid:3:1", "--pairs", "1"]) == 1
    out, err = capsys.readouterr()
    assert " ms" not in out + err
    assert "networkx, both ways answers" in err


def test_no_time_is_printed_where_a_share_is_wrong(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    right = scalar_safety.exact

    def low(line: scalar_safety.Line, preset: Preset) -> float:
        return max(right(line, preset) - 1e-5, 0.0)

    monkeypatch.setattr(scalar_safety, "exact", low)
    assert main(["safety", "--vehicles", "5", "--rounds", "3", "--samples", "10"]) == 1
    out, err = capsys.readouterr()
    assert " us" not in out
    assert "exact, pure Python answers" in err


def test_a_planner_that_knows_nothing_of_the_last_estimate_is_caught(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = graph_of(grid(4, random.Random(1)))
    entries = [replan(REPLAN, graph, AspPlanner), routers.entry("networkx", routers.Networkx, graph)]
    questions = list(islice(draw(graph, random.Random(2)), 20))
    race(entries, questions)
    monkeypatch.setattr(routers.Networkx, "weigh", lambda router, edge, weight: None)  # noqa: ARG005
    with pytest.raises(DisagreementError):
        race(entries, questions)


def test_too_few_steps_for_a_turn_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["full_step", "--steps", "200"])
    assert "200 must be a whole number from 250 on" in capsys.readouterr().err


def test_planning_by_steps_and_compiled_agree_with_the_planner_on_cut_lanes() -> None:
    graph = graph_of(load_map("millbrook", 60.0))
    questions = list(islice(draw(graph, random.Random(3), longest=6), 3))
    entries = [
        replan(REPLAN, graph, AspPlanner),
        asp.enumeration("enumeration", graph, 6),
        asp.minimize("minimize", graph, 6),
        routers.entry("compiled", Compiled, graph),
    ]
    assert len(race(entries, questions, warmup=0)) == 4
    assert all(question.actions <= 6 for question in questions)
