"""What ships is what the sources in ``frontend`` build."""

import hashlib
import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.viewer.made_runs import events, merging, recorded
from tmpud.viewer.comparison import comparison_document
from tmpud.viewer.intact import read_intact

ROOT = Path(__file__).resolve().parents[2]
FRONTEND, PAGE = ROOT / "frontend", ROOT / "src" / "tmpud" / "viewer" / "page"
BUILT = ("replay.js", "replay.css")


def digest() -> str:
    files = ["build.mjs", "package-lock.json", "package.json", "tsconfig.json"]
    files += [f"src/{file.name}" for file in (FRONTEND / "src").iterdir()]
    found = hashlib.sha256()
    for name in sorted(files):
        found.update(name.encode() + b"\0" + (FRONTEND / name).read_bytes() + b"\0")
    return found.hexdigest()


@pytest.mark.parametrize("name", BUILT)
def test_what_ships_was_built_from_these_sources(name: str) -> None:
    banner = (PAGE / name).read_text(encoding="utf-8").partition("\n")[0]
    assert re.findall(r"sources sha256 (\w{64})", banner) == [digest()], "run: make page"


def test_the_template_is_the_one_in_the_sources() -> None:
    assert (PAGE / "replay.html").read_bytes() == (FRONTEND / "src" / "page.html").read_bytes()


def test_a_new_build_gives_what_ships(tmp_path: Path) -> None:
    if not (shutil.which("node") and (FRONTEND / "node_modules" / "esbuild").is_dir()):
        pytest.skip("needs node and frontend/node_modules (make page)")
    subprocess.run(["node", "build.mjs", str(tmp_path)], cwd=FRONTEND, check=True, timeout=120)  # noqa: S607
    assert {file.name for file in tmp_path.iterdir()} == {file.name for file in PAGE.iterdir()}
    for file in tmp_path.iterdir():
        assert file.read_bytes() == (PAGE / file.name).read_bytes()


def test_the_page_reads_all_that_it_is_told(tmp_path: Path) -> None:
    runs = [read_intact(recorded(tmp_path / name, log)) for name, log in (("a", events()), ("b", merging()))]
    told = set(keys(comparison_document(*runs))) - {"schema"}
    read = "".join(file.read_text() for file in (FRONTEND / "src").glob("*.ts") if file.name != "document.ts")
    assert {name for name in told if not re.search(rf"\b{name}\b", re.sub(r"//.*|/\*.*?\*/", "", read))} == set()


def keys(document: Any) -> Iterator[str]:
    """Yield the names of a document's fields; those of a mission, of versions and of lights are data."""
    if isinstance(document, dict):
        yield from document
        for name, value in document.items():
            yield from () if name in ("mission", "versions", "lights") else keys(value)
    elif isinstance(document, list | tuple):
        for value in document:
            yield from keys(value)


def test_the_lock_file_names_packages_by_their_content_and_no_address() -> None:
    text = (FRONTEND / "package-lock.json").read_text(encoding="utf-8")
    assert "://" not in text
    packages = json.loads(text)["packages"]
    assert all(package["integrity"].startswith("sha512-") for name, package in packages.items() if name)
