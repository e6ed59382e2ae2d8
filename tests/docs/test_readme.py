"""What the README tells a reader to run, runs."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

README = (Path(__file__).resolve().parents[2] / "README.md").read_text()
BIN = Path(sys.executable).parent
COMMANDS = re.findall(r"^\.venv/bin/(tmpud .*)$", README, re.MULTILINE)
LONG_NAMES = (
    "paper",
    "learn-world",
    "results",
    "replay",
    "export",
    "view",
)  # long, in need of a result, or without an end
LONG = [command for command in COMMANDS if command.split()[1] in LONG_NAMES]


@pytest.mark.parametrize("command", [command for command in COMMANDS if command not in LONG])
def test_a_command_runs(command: str, tmp_path: Path) -> None:
    words = shlex.split(command, comments=True)
    done = subprocess.run([BIN / words[0], *words[1:]], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert "Traceback" not in done.stderr
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout


@pytest.mark.parametrize("command", LONG)
def test_an_experiment_has_the_options_it_is_told_with(command: str) -> None:
    words = shlex.split(command, comments=True)
    names = words[1:3] if words[1] == "paper" else words[1:2]
    told = subprocess.run([BIN / "tmpud", *names, "--help"], capture_output=True, text=True, check=True).stdout
    assert all(word in told for word in words if word.startswith("--"))


def test_the_python_code_runs(tmp_path: Path) -> None:
    code = README.partition("```python\n")[2].partition("```")[0]
    assert len(code.split("\n")) <= 15
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert re.search(r"Safe\(\w+\) = \d\.\d\d\n.*SUCCESS\n$", done.stdout, re.DOTALL)


def test_make_has_the_targets_that_are_named() -> None:
    makefile = (Path(__file__).resolve().parents[2] / "Makefile").read_text()
    for at_start, quoted in re.findall(r"^make (\w+)|`make (\w+)`", README, re.MULTILINE):
        assert re.search(rf"^{at_start or quoted}:", makefile, re.MULTILINE), at_start or quoted
