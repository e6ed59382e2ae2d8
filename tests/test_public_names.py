"""``import tmpud`` is quick and gives the names that its docstring lists."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

import tmpud


def test_every_public_name_exists_and_is_explained() -> None:
    explained = set(re.findall(r"``(\w+)``", tmpud.__doc__ or ""))
    events = {"Estimated", "Executed", "Finished", "Frame", "Header", "Judged", "Planned", "Refused"}
    for name in tmpud.__all__:
        assert getattr(tmpud, name) is not None
        assert name in explained | events, f"{name} is not in the docstring"


def test_importing_the_package_imports_nothing_heavy() -> None:
    code = "import tmpud, sys; print([m for m in ('numpy', 'clingo', 'libsumo', 'matplotlib') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_another_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Misson'"):
        _ = tmpud.Misson
