"""The towns that ship with the package (built by ``tools/build_towns.py``), and the mission that each is made for."""

from __future__ import annotations

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
