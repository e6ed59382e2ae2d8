"""``replay --gif`` and ``drive --gif`` as a user meets them."""

from __future__ import annotations

import json
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from tests.viewer.made_runs import recorded
from tmpud.recording import LOG, REPLAY

TMPUD = Path(sys.executable).parent / "tmpud"
DRIVE = ("drive", "--from", "park1e_0", "--to", "park2e_0", "--traffic", "0", "--seed", "1")


def run(*words: object, most: int = -1, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run tmpud; files of more than ``most`` bytes cannot be written, as on a full disk."""
    limit = (lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))) if most >= 0 else None
    command = [str(TMPUD), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, check=False, preexec_fn=limit, cwd=cwd)


def test_a_run_is_replayed_as_a_gif_and_nothing_else_is_written(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    done = run("replay", folder, "--gif", tmp_path / "film.gif", "--to", "1", "--width", "320")
    assert (done.returncode, done.stdout) == (0, "")
    assert "showing 0.0 s to 1.0 s of the drive: as asked" in done.stderr
    with Image.open(tmp_path / "film.gif") as gif:
        assert (gif.format, gif.size) == ("GIF", (320, 200))
    assert not (folder / REPLAY).exists()


def test_what_a_run_lacks_is_told_beside_its_gif(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    log = (folder / LOG).read_bytes()
    (folder / LOG).write_bytes(log[: len(log) - 20])
    done = run("replay", folder, "--gif", tmp_path / "film.gif", "--to", "1", "--width", "320")
    assert (done.returncode, done.stdout) == (0, "")
    assert "missing: the run has no end" in done.stderr


def test_a_drive_can_end_with_its_gif(tmp_path: Path) -> None:
    done = run(*DRIVE, "--json", "--out", "run", "--gif", "film.gif", cwd=tmp_path)
    assert (done.returncode, json.loads(done.stdout)["status"]) == (0, "SUCCESS")
    assert (tmp_path / "film.gif").read_bytes().startswith(b"GIF8")


def test_a_drive_without_frames_cannot_be_filmed_and_is_not_begun(tmp_path: Path) -> None:
    done = run(*DRIVE, "--no-frames", "--gif", "film.gif", cwd=tmp_path)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert "--no-frames" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words", [("--from", "9"), ("--from", "nan"), ("--speed", "0"), ("--to", "inf", "--from", "5")]
)
def test_a_part_that_is_none_is_an_error_in_one_line(tmp_path: Path, words: tuple[str, ...]) -> None:
    done = run("replay", recorded(tmp_path / "run"), "--gif", tmp_path / "film.gif", *words)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1), done.stderr
    assert not (tmp_path / "film.gif").exists()


def test_a_full_disk_is_an_error_in_one_line_and_leaves_nothing(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "run")
    done = run("replay", folder, "--gif", tmp_path / "film.gif", most=4000)
    assert (done.returncode, done.stderr.splitlines()[1:]) == (2, [f"tmpud: {tmp_path / 'film.gif'}: File too large"])
    assert [file.name for file in tmp_path.iterdir()] == ["run"]


def test_a_full_disk_ends_a_video_in_one_line_and_leaves_nothing(tmp_path: Path) -> None:
    pytest.importorskip("imageio_ffmpeg")
    done = run("replay", recorded(tmp_path / "run"), "--mp4", tmp_path / "film.mp4", most=4000)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 2), done.stderr
    assert str(tmp_path / "film.mp4") in done.stderr.splitlines()[1]
    assert [file.name for file in tmp_path.iterdir()] == ["run"]


def test_without_the_extra_its_name_is_told(tmp_path: Path) -> None:
    code = "import sys; sys.modules['imageio_ffmpeg'] = None; from tmpud.cli import main; main()"
    words = ["replay", str(recorded(tmp_path / "run")), "--mp4", str(tmp_path / "film.mp4")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert 'pip install "tmpud[video]"' in done.stderr
