import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from tests.roads.nets import CROSSING
from tests.roads.opendrive.crossroads import crossroads
from tests.viewer.made_runs import events, header, merging, recorded
from tmpud.cli import INTERRUPTED, main
from tmpud.errors import TmpudError
from tmpud.roads.towns import PAPER_MISSIONS

START, GOAL, _ = PAPER_MISSIONS["millbrook"]
MISSION = ("--from", START, "--to", GOAL)


class Result(NamedTuple):
    code: int | str | None
    out: str
    err: str

    @property
    def json(self) -> Any:
        assert self.code == 0, self.err
        assert self.err == ""
        (line,) = self.out.splitlines()
        return json.loads(line)

    @property
    def refusal(self) -> str:
        """The one line on stderr of a user's error."""
        assert (self.code, self.out) == (2, "")
        assert "Traceback" not in self.err
        (line,) = self.err.splitlines()
        assert line.startswith("tmpud: ")
        return line.removeprefix("tmpud: ")


Tmpud = Callable[..., Result]


@pytest.fixture
def tmpud(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Tmpud:
    """Return what runs the command line in this process, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def run(*words: str) -> Result:
        monkeypatch.setattr(sys, "argv", ["tmpud", *words])
        code: int | str | None = 0
        try:
            main()
        except SystemExit as end:
            code = end.code
        out, err = capsys.readouterr()
        return Result(code, out, err)

    return run


def in_a_process(folder: Path, *words: str, hash_seed: str = "0") -> Result:
    """Run the command line in a fresh process."""
    done = subprocess.run(
        [sys.executable, "-m", "tmpud", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        env={**os.environ, "PYTHONHASHSEED": hash_seed},
    )
    return Result(done.returncode, done.stdout, done.stderr)


@pytest.fixture
def crossing(tmp_path: Path) -> str:
    (tmp_path / "crossing.net.xml").write_text(CROSSING, encoding="utf-8")
    return "crossing.net.xml"


# Plans, maps, programs ---------------------------------------------------------------------------------------------


def test_plan_gives_one_json_object(tmpud: Tmpud) -> None:
    plan = tmpud("plan", *MISSION, "--json").json
    assert set(plan) == {"actions", "lanes", "cost_m", "penalty_m", "optimal"}
    assert plan["actions"][0] == "mergeleft"
    assert len(plan["lanes"]) == len(plan["actions"]) + 1
    assert plan["lanes"][0] == START
    assert plan["lanes"][-1].startswith(GOAL)
    assert plan["optimal"] is True
    assert plan["penalty_m"] == 0.0
    assert 400 < plan["cost_m"] < 460


def test_plan_in_words_names_every_action_and_the_proof(tmpud: Tmpud) -> None:
    plan, told = tmpud("plan", *MISSION, "--json").json, tmpud("plan", *MISSION)
    *rows, last = told.out.splitlines()
    assert [row.split()[0] for row in rows] == plan["actions"]
    assert f"{plan['cost_m']:.2f} m" in last
    assert last.endswith("optimal, proved by clingo")


def test_a_place_on_the_way_is_driven_to_first(tmpud: Tmpud) -> None:
    lanes = tmpud("plan", *MISSION, "--via", "church1e_0", "--json").json["lanes"]
    assert "church1e_0" in lanes
    assert lanes[-1].startswith(GOAL)


def test_plan_tells_what_the_proof_took_where_it_is_asked_to(tmpud: Tmpud) -> None:
    plan, told = tmpud("plan", *MISSION, "--verbose", "--json").json, tmpud("plan", *MISSION, "--verbose").out
    assert plan["rounds"] == 1
    assert plan["transitions"] >= len(plan["actions"])
    assert plan["ground_ms"] > 0 < plan["solve_ms"]
    assert all(
        re.search(rf"^{name} +[\d.]+$", told, re.M) for name in ("rounds", "transitions", "ground_ms", "solve_ms")
    )


def test_plan_keeps_rules_from_a_file(tmpud: Tmpud, tmp_path: Path) -> None:
    first = tmpud("plan", *MISSION, "--json").json
    turn = first["lanes"][-2].rpartition("_")[0]
    (tmp_path / "town.lp").write_text(f':- onedge("{turn}").\n:~ onedge(E). [100@3, E]\n', encoding="utf-8")
    ruled = tmpud("plan", *MISSION, "--rules", "town.lp", "--json", "--verbose").json
    assert all(not lane.startswith(turn) for lane in ruled["lanes"])
    assert ruled["cost_m"] >= first["cost_m"]
    assert ruled["rules_m"] == len({lane.rpartition("_")[0] for lane in ruled["lanes"]})
    assert ruled["rounds"] > 1
    assert f"{ruled['rules_m']:.2f} m by the rules" in tmpud("plan", *MISSION, "--rules", "town.lp").out


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        (b"% fine\n:- a b.", r"^town\.lp:2: syntax error"),
        (b':- onlane("atlantis_0").', r"^town\.lp:1: lane 'atlantis_0' is not on millbrook; there is \["),
        (b"\xff", r"^town\.lp: cannot be read"),
        (None, r"^town\.lp: not a file"),
    ],
)
def test_rules_that_cannot_be_used_are_named_with_their_line(
    tmpud: Tmpud, tmp_path: Path, rules: bytes | None, said: str
) -> None:
    if rules is not None:
        (tmp_path / "town.lp").write_bytes(rules)
    assert re.search(said, tmpud("plan", *MISSION, "--rules", "town.lp").refusal)


def test_a_start_that_is_the_goal_needs_no_action(tmpud: Tmpud) -> None:
    plan = tmpud("plan", "--from", START, "--to", START, "--json").json
    assert (plan["actions"], plan["lanes"], plan["cost_m"]) == ([], [], 0)


def test_random_places_are_the_same_for_the_same_seed(tmpud: Tmpud) -> None:
    words = ("plan", "--from", "random", "--to", "random", "--json", "--seed")
    assert tmpud(*words, "3").json == tmpud(*words, "3").json != tmpud(*words, "4").json


@pytest.mark.parametrize("of_map", [(), ("millbrook",)])
def test_map_info_gives_one_json_object(tmpud: Tmpud, of_map: tuple[str, ...]) -> None:
    info = tmpud("map", "info", *of_map, "--json").json
    assert info["name"] == "millbrook"
    assert all(info[key] for key in ("segments", "lanes", "junctions", "signals"))


def test_map_info_in_words_has_a_line_for_each_fact(tmpud: Tmpud) -> None:
    facts = tmpud("map", "info", "--json").json
    assert len(tmpud("map", "info").out.splitlines()) == len(facts)


def test_the_edges_of_a_map_and_their_lanes_can_be_listed(tmpud: Tmpud) -> None:
    edges, told = tmpud("map", "info", "--edges", "--json").json, tmpud("map", "info", "--edges").out
    assert any(START in lanes for lanes in edges.values())
    assert GOAL in edges
    assert [line.split()[0] for line in told.splitlines()] == list(edges)


def test_opendrive_becomes_a_net_beside_it_on_which_plans_are_made(tmpud: Tmpud, tmp_path: Path) -> None:
    (tmp_path / "town.xodr").write_text(crossroads(), encoding="utf-8")
    assert tmpud("map", "import", "town.xodr").out.startswith("wrote town.net.xml.gz: 28 lanes")
    assert tmpud("map", "info", "town.net.xml.gz", "--json").json["lanes"] == 28
    mission = ("--from=-100,-5.25", "--to", "1.75,60", "--map", "town.net.xml.gz")
    assert "turnleft" in tmpud("plan", *mission, "--json").json["actions"]


def test_what_cannot_be_imported_is_one_line(tmpud: Tmpud, tmp_path: Path) -> None:
    (tmp_path / "town.xodr").write_text("<OpenDRIVE/>", encoding="utf-8")
    assert tmpud("map", "import", "town.xodr").refusal == "town.xodr:1: OpenDRIVE: the header is missing"
    assert "cannot be read" in tmpud("map", "import", "missing.xodr").refusal
    assert ".net.xml" in tmpud("map", "import", "town.xodr", "--out", "town.xml").refusal


def test_plain_clingo_finds_the_same_optimum_in_what_asp_dump_writes(tmpud: Tmpud, tmp_path: Path) -> None:
    plan = tmpud("plan", *MISSION, "--json").json
    assert tmpud("asp", "dump", *MISSION, "--out", "program").code == 0
    files = sorted(str(path) for path in (tmp_path / "program").iterdir())
    assert len(files) == 5
    done = subprocess.run(
        [sys.executable, "-m", "clingo", *files, "--outf=2"], capture_output=True, text=True, timeout=60, check=False
    )
    answer = json.loads(done.stdout)
    assert answer["Result"] == "OPTIMUM FOUND"
    (call,) = answer["Call"]
    best = call["Witnesses"][-1]
    assert best["Costs"][0] == pytest.approx(plan["cost_m"] * 100, abs=len(plan["actions"]) / 2 + 0.5)
    assert best["Costs"][1:] == [plan["actions"].count("mergeleft"), len(plan["actions"])]
    assert sorted(atom.split(",")[2] for atom in best["Value"]) == sorted(plan["actions"])


# Errors ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--map", "atlantis"), "no such town (there are: millbrook)"),
        (("--map", "gone.net.xml"), "gone.net.xml"),
        (("--from", "park1e_9"), "'park1e_9' is not a lane"),
        (("--to", "nowhere"), "'nowhere' is not a lane"),
        (("--to", "1e9,0"), "1e9,0"),
        (("--to", "99999,0"), "is not on a road"),
        (("--via", ""), "is not a lane"),
        (("--preset", "nope"), "no preset is called 'nope'; there are tmpud, paper, released"),
    ],
)
@pytest.mark.parametrize("command", [("plan",), ("asp", "dump"), ("drive",)], ids=lambda words: words[0])
def test_what_the_map_does_not_have_is_one_line(
    tmpud: Tmpud, tmp_path: Path, command: tuple[str, ...], words: tuple[str, ...], said: str
) -> None:
    mission = {"--from": START, "--to": GOAL, words[0]: words[1]}
    assert said in tmpud(*command, *(word for pair in mission.items() for word in pair)).refusal
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--algorithm", "fastest"), "no algorithm is called 'fastest'; there are tmpud, no-com, threshold"),
        (("--preset", "tmpud:gama=1500"), "gama"),
        (("--out", "Bad Name"), "'Bad Name' is no name for a run"),
        (("--out", "runs/../Up"), "'Up' is no name for a run"),
    ],
)
def test_drive_refuses_what_it_does_not_know(tmpud: Tmpud, words: tuple[str, ...], said: str) -> None:
    assert said in tmpud("drive", *MISSION, *words).refusal


def test_a_preset_with_a_change_names_its_run_folder(tmpud: Tmpud, tmp_path: Path) -> None:
    words = ("--from", "park2e_0", "--to", "park2e_0", "--traffic", "0", "--no-frames", "--preset", "tmpud:gamma=1500")
    assert tmpud("drive", *words).code == 0
    assert [folder.name for folder in (tmp_path / "runs").iterdir()] == ["millbrook-tmpud-gamma-1500-tmpud-7"]


def test_a_folder_that_cannot_be_made_is_named(tmpud: Tmpud, tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("in the way", encoding="utf-8")
    assert tmpud("asp", "dump", *MISSION, "--out", "letter.txt").refusal == "letter.txt: File exists"


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (CROSSING[:900], ""),
        (CROSSING.replace('shape="0.00,-4.80 90.00,-4.80"', 'shape="0.00,nan 90.00,-4.80"'), "nan"),
        ("<!DOCTYPE net [<!ENTITY a 'b'>]><net/>", ""),
        ("", ""),
        ("\x00\x01", ""),
    ],
)
def test_a_damaged_net_is_named_with_its_line(tmpud: Tmpud, tmp_path: Path, damage: str, said: str) -> None:
    (tmp_path / "bad.net.xml").write_text(damage, encoding="utf-8")
    for command in (("map", "info", "bad.net.xml"), ("plan", *MISSION, "--map", "bad.net.xml")):
        refusal = tmpud(*command).refusal
        assert refusal.startswith("bad.net.xml")
        assert said in refusal


@pytest.mark.parametrize(
    "words", [("--beta", "2"), ("--beta", "nan"), ("--traffic", "-1"), ("--seed", "x"), ("--odd",)]
)
def test_an_option_out_of_range_is_refused_without_a_traceback(tmpud: Tmpud, words: tuple[str, ...]) -> None:
    result = tmpud("drive", *MISSION, *words)
    assert (result.code, result.out) == (2, "")
    assert words[0] in result.err
    assert "Traceback" not in result.err


def test_beta_is_refused_where_nothing_goes_by_it(tmpud: Tmpud) -> None:
    result = tmpud("drive", *MISSION, "--beta", "0.5")
    assert result.code == 2
    assert "only --algorithm threshold accepts by it, not tmpud" in " ".join(result.err.split())


def test_a_goal_that_cannot_be_reached_is_told_with_what_cuts_it_off(tmpud: Tmpud, crossing: str) -> None:
    result = tmpud("plan", "--map", crossing, "--from", "side_0", "--to", "north_0")
    assert (result.code, result.out) == (1, "")
    (line,) = result.err.splitlines()
    assert line.startswith("tmpud: leg 1 of 1: goal north_0 is cut off from side_0/0; 6 segments can be reached; ")
    assert line.endswith("nothing leads from there to the lanes before the goal: in_1, in_2")


def test_debug_shows_the_traceback(tmpud: Tmpud) -> None:
    from tmpud.errors import MapError

    with pytest.raises(MapError):
        tmpud("map", "info", "atlantis", "--debug")


def test_help_names_the_commands(tmpud: Tmpud) -> None:
    for command in ("demo", "drive", "plan", "map", "asp"):
        assert command in tmpud("--help").out


def test_help_says_what_every_exit_code_of_an_error_means(tmpud: Tmpud) -> None:
    said = tmpud("--help").out.partition("Exit codes:\n")[2]
    listed = {int(line.split()[0]) for line in said.splitlines() if line.strip()}
    errors: list[type[TmpudError]] = [TmpudError, *TmpudError.__subclasses__()]
    assert listed == {0, INTERRUPTED, *(error.exit_code for error in errors)}


def test_the_version_is_the_packages(tmpud: Tmpud) -> None:
    assert tmpud("--version") == Result(0, f"tmpud {version('tmpud')}\n", "")


@pytest.mark.parametrize("command", [("plan",), ("asp", "dump"), ("drive",)])
def test_commands_on_a_journey_take_the_same_options(tmpud: Tmpud, command: tuple[str, ...]) -> None:
    journey = ["--from", "--to", "--map", "--via", "--seed", "--preset"]
    words = re.findall(r"^ +(?:-m, )?(--\w+)", tmpud(*command, "--help").out, re.MULTILINE)
    assert words[: len(journey)] == journey


# Drives ------------------------------------------------------------------------------------------------------------

DRIVE = ("drive", "--from", "a_0", "--to", "goal")


@pytest.fixture(scope="module")
def summary(blocks_net: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Return what a drive of two blocks prints as JSON."""
    folder = tmp_path_factory.mktemp("drive")
    result = in_a_process(folder, *DRIVE, "--map", str(blocks_net), "--traffic", "5", "--seed", "3", "--json")
    found: dict[str, Any] = result.json
    assert {path.name for path in next((folder / "runs").glob("*-tmpud-3")).iterdir()} == {
        "run.jsonl.gz", "timing.jsonl", "map.png",
    }  # fmt: skip
    return found


def test_drive_gives_one_json_object_with_all_its_keys(summary: dict[str, Any]) -> None:
    assert set(summary) >= {
        "schema_version", "seed", "status", "distance_m", "travel_time_s", "collisions", "forced_stops", "replans",
        "plans", "estimates", "latency_ms",
    }  # fmt: skip
    assert (summary["schema_version"], summary["seed"], summary["status"]) == (1, 3, "SUCCESS")
    assert all(isinstance(summary[key], int) for key in ("collisions", "forced_stops", "replans"))
    assert 225 < summary["distance_m"] < 240
    assert 40 < summary["travel_time_s"] < 300


def test_drive_tells_the_terms_of_every_plan_and_every_estimate(summary: dict[str, Any]) -> None:
    for plan in summary["plans"]:
        assert set(plan) == {"actions", "cost_m", "penalty_m"}
        assert set(plan["actions"]) <= {"mergeleft", "mergeright", "forward", "turnleft", "turnright"}
    assert len(summary["plans"]) == summary["replans"] + 1
    assert len(summary["estimates"]) >= 4
    for estimate in summary["estimates"]:
        assert set(estimate) == {"action", "lane", "safe"}
        assert 0.0 <= estimate["safe"] <= 1.0
    assert summary["estimates"][0]["lane"] == "a_0"


def test_drive_tells_its_latencies_apart(summary: dict[str, Any]) -> None:
    for kind in ("plan", "estimate"):
        assert set(summary["latency_ms"][kind]) == {"n", "median", "max"}
    assert summary["latency_ms"]["estimate"]["n"] == len(summary["estimates"])


def test_drive_in_words_ends_with_a_table_and_names_what_it_wrote(blocks_net: Path, tmp_path: Path) -> None:
    result = in_a_process(tmp_path, *DRIVE, "--map", str(blocks_net), "--traffic", "0", "--algorithm", "no-com")
    assert (result.code, result.err) == (0, "")
    lines = result.out.splitlines()
    assert lines[1] == "no-com, preset tmpud, 0 vehicles, seed 7"
    assert any(line.split()[:2] == ["status", "SUCCESS"] for line in lines)
    assert lines[-1].startswith("wrote map.png, run.jsonl.gz, timing.jsonl to runs/")
    assert lines[-1].endswith("-tmpud-no-com-7")


def test_a_drive_to_where_it_starts_is_a_success_with_an_empty_plan(blocks_net: Path, tmp_path: Path) -> None:
    words = ("drive", "--from", "a_0", "--to", "a_0", "--map", str(blocks_net), "--traffic", "0", "--json")
    result = in_a_process(tmp_path, *words)
    summary = json.loads(result.out)
    assert (result.code, summary["status"], summary["distance_m"]) == (0, "SUCCESS", 0)
    assert [plan["actions"] for plan in summary["plans"]] == [[]]
    assert "Traceback" not in result.err


def test_a_drive_to_a_goal_that_is_cut_off_is_no_plan_and_says_why(spur_net: Path, tmp_path: Path) -> None:
    words = ("drive", "--from", "spur_0", "--to", "ab", "--map", str(spur_net), "--traffic", "0", "--json")
    result = in_a_process(tmp_path, *words)
    summary = json.loads(result.out)
    assert summary["status"] == "NO_PLAN"
    assert "goal ab is cut off from spur_0/0" in summary["message"]
    assert "nothing leads" in summary["message"]
    assert "Traceback" not in result.err


@pytest.mark.parametrize(
    ("words", "needed"),
    [(("--help",), set()), (("--version",), set()), (("plan", *MISSION), {"clingo"}), (("map", "info"), set())],
)
def test_a_quick_command_imports_nothing_that_it_does_not_need(words: tuple[str, ...], needed: set[str]) -> None:
    slow = ("clingo", "libsumo", "matplotlib", "numpy", "pydantic", "rich", "yaml")
    code = f"""
import sys
from tmpud.cli import main
sys.argv[1:] = {list(words)}
try:
    main()
finally:
    print(*({set(slow)} & sys.modules.keys()), file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert set(done.stderr.split()) == needed


def test_a_replay_is_written_beside_its_run_or_where_it_is_wanted(tmp_path: Path, tmpud: Tmpud) -> None:
    folder = recorded(tmp_path / "run")
    assert tmpud("replay", str(folder)).code == 0
    wanted = tmp_path / "other" / "page.html"
    assert str(wanted) in tmpud("replay", str(folder), "--html", str(wanted)).out
    assert wanted.read_bytes() == (folder / "replay.html").read_bytes()


def test_a_replay_of_two_runs_is_written_beside_the_first(tmp_path: Path, tmpud: Tmpud) -> None:
    folders = [recorded(tmp_path / name, log) for name, log in (("a", events()), ("b", merging()))]
    result = tmpud("replay", str(folders[0]), "--with", str(folders[1]))
    assert (result.code, result.err) == (0, "")
    assert str(folders[0] / "compare.html") in result.out


def test_runs_of_two_maps_are_not_compared(tmp_path: Path, tmpud: Tmpud) -> None:
    elsewhere = [replace(header(), map={"name": "atlantis", "digest": "0"}), *events()[1:]]
    folders = [recorded(tmp_path / "a"), recorded(tmp_path / "b", elsewhere)]
    assert "only runs on the same map" in tmpud("replay", str(folders[0]), "--with", str(folders[1])).refusal
    assert not (folders[0] / "compare.html").exists()


def test_a_replay_of_an_experiment_says_how_its_trials_are_replayed(tmp_path: Path, tmpud: Tmpud) -> None:
    (tmp_path / "results.jsonl").touch()
    assert "--trial KEY" in tmpud("replay", str(tmp_path)).refusal


@pytest.mark.parametrize("given", [".", "letter.txt"])
def test_a_replay_of_no_run_is_refused(tmp_path: Path, tmpud: Tmpud, given: str) -> None:
    (tmp_path / "letter.txt").write_text("no run", encoding="utf-8")
    result = tmpud("replay", given)
    assert (result.code, result.out) == (4, "")
    assert "no such run" in result.err
