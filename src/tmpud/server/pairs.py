"""Two runs, or two trials, beside each other on one page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tmpud.server.summaries import Summary


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two; every text may be hostile."""

    id: str  # the last part of its own page's address
    name: str
    state: str  # ENDED, WRITTEN or BROKEN
    status: str
    about: str
    shown: bool  # whether there is something to play
    version: str = ""


def side_of(number: str, name: str, summary: Summary) -> Side:
    """Return a run as one side."""
    return Side(number, name, summary.state, summary.status, summary.about, summary.shown, summary.version)


def pair_of(root: str, back: Sequence[tuple[str, str]], sides: Sequence[Side]) -> dict[str, Any]:
    """Return what the page is told; ``back`` are the links above it."""
    return {
        "root": root,
        "part": f"{sides[1].id}/part",
        "back": back,
        "sides": sides,
        "shown": all(side.shown for side in sides),
        "version": " ".join(side.version for side in sides),
    }
