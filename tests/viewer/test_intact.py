import gzip
import json
import math
import random
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.made_runs import events, frame, recorded
from tmpud.errors import RunFileError
from tmpud.events import Frame, to_json
from tmpud.recording import LOG
from tmpud.roads.loading import load_map
from tmpud.viewer.document import replay_document
from tmpud.viewer.intact import read_intact
from tmpud.viewer.replay import write_replay


def test_a_whole_run_misses_nothing(tmp_path: Path) -> None:
    run = read_intact(recorded(tmp_path / "run"))
    document = replay_document(run)
    assert run.missing == document["missing"] == []
    told = [to_json(event) for event in events()[1:] if not isinstance(event, Frame)]
    assert [to_json(event) for event in run.events] == told
    assert run.frames == [event for event in events() if isinstance(event, Frame)]
    assert [plan["name"] for plan in document["plans"]] == ["A", "B"]
    assert all(step[2] for step in document["steps"])


@pytest.mark.parametrize("share", [0.5, 0.8, 0.99])
def test_a_run_that_breaks_off_shows_what_is_intact_and_says_so(tmp_path: Path, share: float) -> None:
    folder = recorded(tmp_path / "run")
    whole = (folder / LOG).read_bytes()
    (folder / LOG).write_bytes(whole[: round(len(whole) * share)])
    try:
        missing = write_replay(folder, tmp_path / "page.html")
    except RunFileError as error:
        assert "no header" in str(error)  # noqa: PT017 - so short a file may hold no whole line
        return
    assert [line for line in missing if "the run has no end: it is still going on, or was cut off after line" in line]
    assert not any("damaged" in line for line in missing)
    assert (tmp_path / "page.html").stat().st_size > 10_000


def test_a_run_that_has_only_begun_is_said_to_have(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    (folder / LOG).write_bytes((folder / LOG).read_bytes()[:10])
    with pytest.raises(RunFileError, match="it has only begun, or was cut off"):
        read_intact(folder)


def test_only_the_end_mark_of_a_finished_log_may_be_missing_without_a_word(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    (folder / LOG).write_bytes((folder / LOG).read_bytes()[:-8])
    assert read_intact(folder).missing == []


def test_a_byte_that_was_changed_is_damage(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    whole = bytearray((folder / LOG).read_bytes())
    whole[-5] ^= 0xFF  # of the length
    (folder / LOG).write_bytes(whole)
    assert "everything after line" in read_intact(folder).missing[0]


def test_damaged_lines_are_left_out_and_named(tmp_path: Path) -> None:
    lines = [json.dumps(to_json(event)) for event in events()]
    lines[2], lines[10], lines[20] = "{", '{"event":"Frame","time":"soon"}', "null"
    write_lines(tmp_path, lines)
    run = read_intact(tmp_path)
    assert run.missing == ["damaged in the log and left out: line 3, line 11, line 21"]
    assert 1 + len(run.events) + len(run.frames) + 3 == len(lines)


def test_a_frame_out_of_order_is_left_out_and_named(tmp_path: Path) -> None:
    run = read_intact(recorded(tmp_path / "run", [*events(), frame(3)]))
    assert run.frames == [event for event in events() if isinstance(event, Frame)]
    assert "the frame of 10.4 s, which is out of order" in run.missing[0]


def write_lines(folder: Path, lines: list[str]) -> None:
    with gzip.open(folder / LOG, "wt", encoding="utf-8") as log:
        log.write("\n".join(lines) + "\n")


def test_no_damage_to_a_value_ends_in_anything_but_a_page_or_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tmpud.viewer.paths.load_map", cache(load_map))
    rows = [to_json(event) for event in events()]
    rng = random.Random(5)
    step = ["a", 0, "forward", "b", 0]
    values: tuple[Any, ...] = (None, -1, 1e300, "x", [], {}, [[]], [None], True, "inf", math.inf, {"a": []}, [step])
    for _ in range(300):
        damaged = [dict(row) for row in rows]
        for _ in range(3):
            row = rng.choice([*damaged[:6], *damaged[-4:]])
            row[rng.choice(list(row))] = rng.choice(values)
        write_lines(tmp_path, [json.dumps(row) for row in damaged])
        try:
            json.dumps(replay_document(read_intact(tmp_path)), allow_nan=False)
        except RunFileError as error:
            assert "\n" not in str(error)  # noqa: PT017


@pytest.mark.parametrize(
    ("mission", "told"),
    [
        ({"map": "atlantis"}, "the map cannot be read"),
        ({"map": None}, "the map cannot be read"),
        ({"preset": "bold"}, "the map cannot be read"),
        ({"request": {}}, "no plan is drawn"),
        ({"settings": {}}, "cannot be explained"),
    ],
)
def test_what_the_header_does_not_tell_is_missing(tmp_path: Path, mission: dict[str, object], told: str) -> None:
    document = replay_document(read_intact(recorded(tmp_path / "run", events(**mission))))
    assert any(told in line for line in document["missing"])
    assert len(document["plans"]) == 2


def test_another_map_of_the_same_name_is_not_drawn(tmp_path: Path) -> None:
    log = [replace(events()[0], map={"name": "millbrook", "digest": "0" * 64}), *events()[1:]]  # type: ignore[call-arg]
    document = replay_document(read_intact(recorded(tmp_path / "run", log)))
    assert document["ground"] is None
    assert "is not the map it was" in document["missing"][0]


def test_no_run_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(RunFileError, match="no such run"):
        write_replay(tmp_path, tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()
