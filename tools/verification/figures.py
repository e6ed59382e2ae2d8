"""What a verification found: figures with their n, the JSON they are kept in, and the table people read."""

from __future__ import annotations

import importlib.metadata
import json
import os
import platform
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("tmpud", "clingo", "libsumo", "numpy", "shapely")
INTRODUCTION = """# Verification

Written by `make verify` (`python -m tools.verify`); each row says how to repeat it alone. A section that is run alone
replaces its own rows only, so each has its date and commit; a `+` behind a commit says that files had changed since.
None found in n bounds the rate at 3/n (95 %). `verification.json` holds the same numbers and what they are made of.

| what | repeat it with | n | seed | result | target | holds | when, commit |
|---|---|---|---|---|---|---|---|
"""


@dataclass(frozen=True, slots=True)
class Figure:
    """One claim and what was found."""

    what: str
    n: int
    result: str
    target: str
    holds: bool
    seed: int
    details: Mapping[str, Any] = field(default_factory=dict)


def none_in(n: int) -> str:
    """Return what finding none in n says about the rate."""
    return f"0 of {n:,} (rate below {3 / n:.2g})" if n > 3 else f"0 of {n}"


def provenance(command: str) -> dict[str, Any]:
    """Return all that is needed to repeat a section that begins now."""
    return {
        "command": command,
        "date": datetime.now(UTC).strftime("%Y-%m-%d"),
        "commit": _commit(),
        "versions": {name: importlib.metadata.version(name) for name in PACKAGES}
        | {"python": platform.python_version()},
        "system": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
    }


def section(begun: Mapping[str, Any], figures: Sequence[Figure], seconds: float) -> dict[str, Any]:
    """Return what is kept of a section."""
    return {**begun, "seconds": round(seconds, 1), "figures": [asdict(figure) for figure in figures]}


def keep(folder: Path, name: str, found: Mapping[str, Any]) -> None:
    """Put a section into ``verification.json``, beside those already there, and write the table anew."""
    folder.mkdir(parents=True, exist_ok=True)
    sections = kept(folder) | {name: dict(found)}
    _replace(folder / "verification.json", json.dumps(sections, indent=1, sort_keys=True) + "\n")
    _replace(folder / "verification.md", table(sections))


def kept(folder: Path) -> dict[str, Any]:
    """Return the sections written earlier."""
    file = folder / "verification.json"
    return dict(json.loads(file.read_text(encoding="utf-8"))) if file.exists() else {}


def table(sections: Mapping[str, Any]) -> str:
    """Return the figures of all sections as Markdown."""
    rows = [_row(figure, found) for _, found in sorted(sections.items()) for figure in found["figures"]]
    return INTRODUCTION + "".join(rows) + "\n" + _versions(sections)


def _row(figure: Mapping[str, Any], found: Mapping[str, Any]) -> str:
    cells = (
        figure["what"], f"`{found['command']}`", f"{figure['n']:,}", figure["seed"], figure["result"], figure["target"],
        "yes" if figure["holds"] else "**no**", f"{found['date']}, {found['commit']}",
    )  # fmt: skip
    return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |\n"


def _versions(sections: Mapping[str, Any]) -> str:
    used: dict[str, list[str]] = {}
    for name, found in sorted(sections.items()):
        versions = ", ".join(f"{package} {version}" for package, version in sorted(found["versions"].items()))
        used.setdefault(f"{versions}; {found['system']}", []).append(f"{name} ({found['seconds']:.0f} s)")
    return "".join(f"{', '.join(names)}: {versions}.\n\n" for versions, names in used.items()).rstrip() + "\n"


def _commit() -> str:
    """Return the checkout's commit, marked where tracked files other than the docs have changed since."""
    commit = _git("rev-parse", "--short=10", "HEAD")
    return (
        commit + ("+" if _git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs") else "")
        if commit
        else "unknown"
    )


def _git(*arguments: str) -> str:
    command = ["git", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip()


def _replace(file: Path, text: str) -> None:
    """Write a file such that it is never seen half written."""
    draft = file.with_suffix(file.suffix + ".part")
    draft.write_text(text, encoding="utf-8")
    draft.replace(file)
