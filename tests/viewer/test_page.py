"""What ships is what the sources in ``frontend`` build."""

import hashlib
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

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


def test_the_lock_file_names_packages_by_their_content_and_no_address() -> None:
    text = (FRONTEND / "package-lock.json").read_text(encoding="utf-8")
    assert "://" not in text
    packages = json.loads(text)["packages"]
    assert all(package["integrity"].startswith("sha512-") for name, package in packages.items() if name)
