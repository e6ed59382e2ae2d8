"""Lights and signs at the stop lines, which are the ends of the lanes that lead into junctions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from tmpud.roads.network import LaneConnection, SignalProgram
from tmpud.roads.opendrive.lanes import LaneParts, Row, Strands
from tmpud.roads.opendrive.links import by_junction
from tmpud.roads.opendrive.strands import Key, Mark

GREEN, YELLOW, RED = 10.0, 3.0, 2.0  # [s] CARLA's own times; red is all red, between two controllers
LIGHTS = frozenset(["1000001", "1000008", "1000009", "1000010", "1000011", "1000012"])
_GIVE_WAY, _STOP = "205", "206"


def with_signals(
    connections: Sequence[LaneConnection], inner: Sequence[Row], lanes: Sequence[LaneParts], lookup: Lookup
) -> tuple[list[LaneConnection], dict[str, tuple[str, ...]]]:
    """Return the connections with their lights and signs, and each junction's lights in the order of its letters.

    A junction's lights are one signal, with the junction's id.
    """
    ends = {each.lane.id: each.parts[-1] for each in lanes}
    held = [lookup.held(ends[connection.from_lane], keys) for connection, keys in zip(connections, inner, strict=True)]
    lights = [next((mark.id for mark in found if mark.kind in LIGHTS), None) for found in held]
    order = {
        junction: tuple(sorted({light for index in indices if (light := lights[index]) is not None}))
        for junction, indices in by_junction(connections).items()
    }
    found = [
        replace(
            connection,
            signal=connection.junction if light else None,
            link=order[connection.junction].index(light) if light else -1,
            priority=_priority(marks),
        )
        for connection, light, marks in zip(connections, lights, held, strict=True)
    ]
    return found, {junction: names for junction, names in order.items() if names}


class Lookup:
    """Finds the marks that count for a way through a junction."""

    def __init__(self, marks: Iterable[Mark], strands: Strands) -> None:
        self._strands = strands
        self._by_road: dict[int, list[Mark]] = {}
        for mark in marks:
            self._by_road.setdefault(mark.road, []).append(mark)

    def held(self, before: Key, way: Row) -> list[Mark]:
        """Return the marks on a way's own roads, and those at the end of the strand before it.

        The latter are those that stand nearer to its end than to its start: as CARLA sees it, the stop line is where
        the way begins, or where the mark says.
        """
        if not way:
            return []
        start, end = self._strands[before].span
        return [
            *(mark for key in way for mark in self._by_road.get(key.road, ()) if mark.holds_for(key)),
            *(
                mark
                for mark in self._by_road.get(before.road, ())
                if mark.holds_for(before) and abs(mark.s - end) <= abs(mark.s - start)
            ),
        ]


def _priority(marks: Iterable[Mark]) -> str:
    """Return SUMO's letter for a sign: s (stop), m (give way), M (none)."""
    kinds = {mark.kind for mark in marks}
    return "s" if _STOP in kinds else "m" if _GIVE_WAY in kinds else "M"


def program(junction: str, lights: tuple[str, ...], groups: Iterable[frozenset[str]]) -> SignalProgram:
    """Return CARLA's default program: its controllers get green one after the other, others have one each.

    Green is "g": turning and crossing traffic still gives way, as CARLA may show green to both.
    """
    turns = [turn for group in groups if (turn := group & set(lights))]
    alone = [frozenset([light]) for light in lights if not any(light in turn for turn in turns)]
    phases: list[tuple[float, str]] = []
    for turn in [*turns, *alone]:
        for duration, letter in ((GREEN, "g"), (YELLOW, "y"), (RED, "r")):
            phases.append((duration, "".join(letter if light in turn else "r" for light in lights)))
    return SignalProgram(junction, 0.0, tuple(phases), lights)
