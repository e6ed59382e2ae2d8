"""What is exported is read again with MCAP's own reader."""

from __future__ import annotations

import math
import subprocess
import sys
from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import decision, events, frame, header, recorded
from tmpud.events import Frame
from tmpud.viewer.intact import Intact, read_intact
from tmpud.viewer.mcap import write_mcap

pytest.importorskip("foxglove")
reader = pytest.importorskip("mcap.reader")
decoding = pytest.importorskip("mcap_protobuf.decoder")


def exported(run: Intact, file: Path) -> dict[str, list[tuple[int, Any]]]:
    """Return the messages of each topic with their times [ns], in the file's order."""
    import json

    write_mcap(run, file)
    found: dict[str, list[tuple[int, Any]]] = defaultdict(list)
    factory = decoding.DecoderFactory()
    with file.open("rb") as raw:
        for schema, channel, message in reader.make_reader(raw).iter_messages():
            decode = factory.decoder_for(channel.message_encoding, schema) or json.loads
            found[channel.topic].append((message.log_time, decode(message.data)))
    return found


def test_every_frame_is_there_at_its_time_with_every_vehicle_where_it_was(tmp_path: Path) -> None:
    run = read_intact(recorded(tmp_path / "run"))
    found = exported(run, tmp_path / "run.mcap")
    assert len(found["/traffic"]) == len(found["/tf"]) == len(found["/ego"]) == len(run.frames)
    rows = zip(run.frames, found["/traffic"], found["/tf"], found["/ego"], strict=True)
    for seen, (time, update), (_, place), (_, ego) in rows:
        assert time == round(seen.time * 1e9) == update.entities[0].timestamp.ToNanoseconds()
        cubes = {entity.id: entity.cubes[0] for entity in update.entities}
        assert cubes.keys() == {"ego", *(f"vehicle {name}" for name in seen.ids)}
        for name, row in zip(seen.ids, seen.others, strict=True):
            cube = cubes[f"vehicle {name}"]
            assert (cube.pose.position.x, cube.pose.position.y) == (row[0] / 100, row[1] / 100)
            assert 2 * math.asin(cube.pose.orientation.z) == pytest.approx(row[2] / 1000)
            assert (cube.size.x, cube.size.y) == (5.0, 1.8)
        assert (place.parent_frame_id, place.child_frame_id) == ("map", "ego")
        assert (place.translation.x, place.translation.y) == (seen.ego[0] / 100, seen.ego[1] / 100)
        assert (ego["x"], ego["speed"]) == (seen.ego[0] / 100, seen.ego[3] / 100)


def test_safe_is_a_series_and_plan_changes_are_log_messages(tmp_path: Path) -> None:
    found = exported(read_intact(recorded(tmp_path / "run")), tmp_path / "run.mcap")
    row = {"safe": 0.5, "least": 0.3, "action": "mergeleft", "worst": "car1"}
    assert found["/safe"] == [(10_000_000_000, row)]
    log = [(time, message.message) for time, message in found["/log"]]
    assert (10_000_000_000, "Replanned from A to B because Safe(mergeleft) = 0.50") in log
    assert any(text.startswith("forced stop") for time, text in log if time == 13_000_000_000)
    assert [time for time, _ in log] == sorted(time for time, _ in log)
    assert [len(plan.entities[0].lines[0].points) > 2 for _, plan in found["/plan"]] == [True, True]
    assert len(found["/trajectory"][0][1].entities[0].lines[0].points) == 5
    ((_, town),) = found["/map"]
    assert len(town.entities[0].triangles[0].points) % 3 == 0


def test_a_vehicle_that_is_gone_leaves_the_scene(tmp_path: Path) -> None:
    frames = [frame(0), frame(1, ("car2",)), frame(2, ("car2",))]
    updates = [update for _, update in exported(Intact(header(), [], frames), tmp_path / "run.mcap")["/traffic"]]
    assert [[gone.id for gone in update.deletions] for update in updates] == [[], ["vehicle car1"], []]


def test_hostile_names_and_a_lost_map_are_no_harm(tmp_path: Path) -> None:
    for name in NAMES:
        frames: list[Frame] = [replace(frame(0), ids=(name, "car2"))]
        run = Intact(header(map=name), decision(name), frames)
        found = exported(run, tmp_path / "run.mcap")
        assert len(found["/traffic"][0][1].entities) == 3
        assert any("no roads are drawn" in line for line in run.missing)


def test_the_same_run_gives_the_same_file(tmp_path: Path) -> None:
    run = Intact(header(), [event for event in events() if not isinstance(event, Frame)], [frame(0), frame(1)])
    for name in ("one", "other"):
        write_mcap(run, tmp_path / name)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "other").read_bytes()


def test_without_the_extra_its_name_is_told_in_one_line(tmp_path: Path) -> None:
    code = "import sys; sys.modules['foxglove'] = None; from tmpud.cli import main; main()"
    words = ["export", str(recorded(tmp_path / "run")), "--mcap", str(tmp_path / "run.mcap")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert 'pip install "tmpud[mcap]"' in done.stderr
