"""The towns that ship with the package (built by ``tools/build_towns.py``), and the mission that each is made for."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple


class Mission(NamedTuple):
    """A drive worth showing: its start and its goal, as a user would write them."""

    start: str
    goal: str
    description: str


# Like the paper's example figure: from the far left to the top right, five plans by way of five lane-changing areas.
PAPER_MISSIONS = {
    "millbrook": Mission(
        start="park1e_0",
        goal="high4n",
        description="From West Street along Park Street, left into High Street and past Church Street: 430 m. "
        "Merge left in the first block or, at no extra distance, the second; or go round by the Avenue or East Street.",
    )
}


def street_names(edges: Iterable[str]) -> dict[str, str]:
    """Return the names of a shipped town's streets by their edges: "park1e" is a part of Park Street."""
    words = {edge: re.sub(r"\d.*", "", edge) for edge in edges}
    return {edge: "The Avenue" if word == "avenue" else f"{word.capitalize()} Street" for edge, word in words.items()}
