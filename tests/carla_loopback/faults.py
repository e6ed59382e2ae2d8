"""What the loopback server does wrong when it is told to. Frames count from when the fault was armed."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Faults:
    """Each is off by default."""

    version: str = ""  # says it is of this version
    die_at: int = 0  # frame at which the process ends
    freeze_at: int = 0  # frame from which on nothing is answered
    nonsense_at: int = 0  # frame from which on the Traffic Manager's questions are answered in another shape
    refused_spawns: int = 0  # how many vehicles are refused
    vanish_at: int = 0  # frame at which vehicles are gone ...
    vanish: int = 0  # ... so many, the newest first
    vanish_first: bool = False  # ... or the oldest
    collision_copies: int = 1  # how often each collision is told
    collision_delay: int = 0  # [frames]

    mirrored: bool = False  # steers the other way
    keeps_actors: bool = False  # says it destroyed what it did not

    def refuses_spawn(self) -> bool:
        self.refused_spawns -= 1
        return self.refused_spawns >= 0

    def vanishing(self, frame: int, actors: list[int]) -> list[int]:
        if not self.vanish_at or frame != self.vanish_at:
            return []
        ordered = sorted(actors, reverse=not self.vanish_first)
        return ordered[: self.vanish]
