"""The server's lights, by their ids in its map, as the letters that the network's connections look up."""

from __future__ import annotations

from collections.abc import Mapping

from tmpud.roads.network import RoadNetwork

DARK = "O"  # a light that is off, or that the server does not have


class Signals:
    """One letter per link for each signal of a network."""

    def __init__(self, network: RoadNetwork) -> None:
        self._heads = {
            name: program.lights or tuple(f"{name}_{link}" for link in range(len(program.phases[0][1])))
            for name, program in network.signals.items()
        }  # netconvert names a signal's heads so where it writes a net as OpenDRIVE
        self.letters: Mapping[str, str] = {}

    def update(self, shown: Mapping[str, str]) -> None:
        """Take in what each light shows."""
        self.letters = {name: "".join(shown.get(head, DARK) for head in heads) for name, heads in self._heads.items()}
