"""The examples run as they are and print what they promise."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).resolve().parents[1] / "examples").glob("*.py"))
PROMISED = {
    "01_plan.py": r"mergeleft +park1e_0/0 -> .*optimal: True\nwith Safe\(mergeleft\) = 0: forward",
    "02_estimate_a_merge.py": r"2 m behind: Safe = 0\.0\d, worst vehicle car.*20 m behind: Safe = 1\.00",
    "03_drive.py": r" s  \w+ +Safe = \d\.\d\d.*SUCCESS: \d+ m in .*0 collisions",
}


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda file: file.name)
def test_an_example_prints_what_it_promises(example: Path) -> None:
    done = subprocess.run([sys.executable, str(example)], capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr
    assert re.search(PROMISED[example.name], done.stdout, re.DOTALL), done.stdout


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda file: file.name)
def test_an_example_is_short(example: Path) -> None:
    assert len(example.read_text().splitlines()) < 60
