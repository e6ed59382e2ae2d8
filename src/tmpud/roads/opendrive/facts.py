"""What an OpenDRIVE file says that ``carla.Map`` does not tell: speed limits, priorities, controllers, road marks.

Source of the format: ASAM OpenDRIVE 1.4, of which CARLA reads a part.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from tmpud.roads.xml_reading import Element, read_xml, shown

LONGEST = 100_000.0  # [m] a longer road is a mistake
MOST = 5_000_000.0  # [m] of all roads together
DEFAULT_SPEED = 50 / 3.6  # [m/s] where the file has no limit
_UNITS = {"m/s": 1.0, "km/h": 1 / 3.6, "mph": 0.44704}
_TAGS = """
header road link predecessor successor type speed planView geometry line arc spiral poly3 paramPoly3 elevationProfile
elevation lateralProfile superelevation lanes laneOffset laneSection left center right lane width roadMark signals
signal signalReference validity controller control junction connection laneLink priority
"""
_TEXTS = """
name id junction type elementType elementId contactPoint unit max level pRange orientation dynamic country subtype text
rule signalId incomingRoad connectingRoad color material laneChange weight sequence high low value
"""
_CHANGES = frozenset(["increase", "decrease", "both", "none"])
_KEPT = frozenset(_TAGS.split())
_NO_NUMBERS = frozenset(_TEXTS.split())  # attributes of these names may be anything
_SHAPES = frozenset(["line", "arc", "spiral", "poly3", "paramPoly3"])


Place = tuple[int, int]  # section, lane


@dataclass(frozen=True, slots=True)
class Road:
    """One road: its sections, and what holds along it."""

    length: float  # [m]
    sections: tuple[float, ...]  # [m] where each begins
    limits: tuple[tuple[float, float], ...]  # (from where [m], limit [m/s])
    lane_limits: Mapping[Place, float]  # the lowest of a lane's own [m/s]
    marks: Mapping[Place, tuple[tuple[float, str], ...]]  # of a lane's outer border: (from where on the road [m],
    # who may cross it: increase, decrease, both or none: whoever goes to a lane of higher or lower number)

    def section_end(self, section: int) -> float:
        """Return where a section ends [m]."""
        return [*self.sections, self.length][section + 1]

    def crossable(self, section: int, border: int, change: str) -> Iterator[tuple[float, float]]:
        """Yield from where to where on a section [m] a lane's outer border may be crossed in a way.

        Where there is no mark it may.
        """
        start, end = self.sections[section], self.section_end(section)
        marks = [(start, "both"), *self.marks.get((section, border), ()), (end, "none")]
        for (here, kind), (there, _) in pairwise(marks):
            if there > here and kind in ("both", change):
                yield here, min(there, end)

    def limit(self, section: int, lane: int) -> float:
        """Return the lowest limit on a lane of a section [m/s]."""
        if (section, lane) in self.lane_limits:
            return self.lane_limits[section, lane]
        start, end = self.sections[section], self.section_end(section)
        first = max(bisect_right(self.limits, start, key=lambda limit: limit[0]) - 1, 0)
        return min((v for s, v in self.limits[first:] if s < end or s <= start), default=DEFAULT_SPEED)


@dataclass(frozen=True, slots=True)
class Facts:
    """What the reader needs beside ``carla.Map``."""

    roads: Mapping[int, Road]
    priorities: Mapping[str, frozenset[tuple[int, int]]]  # junction -> (road that goes first, road that waits)
    controllers: Mapping[str, tuple[frozenset[str], ...]]  # junction -> lights that switch together, in their sequence
    digest: str


def read_facts(path: Path) -> Facts:
    """Read and check a file; MapError where it is not OpenDRIVE, or holds what no map can have."""
    root, digest = read_xml(path, "OpenDRIVE", _KEPT)
    header = next((child for child in root.children if child.tag == "header"), None)
    if header is None:
        raise root.error("the header is missing")
    if header.text("revMajor") != "1":
        raise header.error(f"revMajor={shown(header.text('revMajor'))} is not a version that can be read (1)")
    found: dict[int, Road] = {}
    for element in _children(root, "road"):
        _check_numbers(element)
        number = element.natural("id")
        if number in found:
            raise element.error(f"id {number} is used by two roads")
        found[number] = _road(element)
    if not found:
        raise root.error("there is no road")
    _check_references(root)
    if sum(road.length for road in found.values()) > MOST:
        raise root.error(f"the roads are longer than {MOST:.0f} m together")
    junctions = {junction.text("id"): junction for junction in _children(root, "junction")}
    lights = {
        each.text("id"): frozenset(control.text("signalId") for control in _children(each, "control"))
        for each in _children(root, "controller")
    }
    return Facts(
        found,
        {name: frozenset(_priorities(junction)) for name, junction in junctions.items()},
        {name: tuple(_in_sequence(junction, lights)) for name, junction in junctions.items()},
        digest,
    )


def _road(element: Element) -> Road:
    length = element.number("length", low=0.0)
    if not 0.0 < length <= LONGEST:
        raise element.error(f"length={length:g} is not that of a road (at most {LONGEST:.0f} m)")
    if element.text("rule", "RHT") != "RHT":
        raise element.error("left-hand traffic is not supported; mirror the map first")
    plan = _only(element, "planView")
    if not _children(plan, "geometry"):
        raise plan.error("it has no geometry")
    for geometry in _children(plan, "geometry"):
        geometry.number("length", low=0.0)
        if len([child for child in geometry.children if child.tag in _SHAPES]) != 1:
            raise geometry.error(f"it is not one of: {' '.join(sorted(_SHAPES))}")
    sections = _children(_only(element, "lanes"), "laneSection")
    starts = tuple(section.number("s", low=0.0) for section in sections)
    if not starts or list(starts) != sorted(set(starts)) or starts[-1] >= length:
        raise element.error("its lane sections do not follow one another within its length")
    return Road(length, starts, tuple(_limits(element)), dict(_lane_limits(sections)), dict(_marks(sections)))


def _only(element: Element, tag: str) -> Element:
    found = _children(element, tag)
    if len(found) != 1:
        raise element.error(f"it has {len(found)} {tag}, not one")
    return found[0]


def _children(element: Element, tag: str) -> list[Element]:
    return [child for child in element.children if child.tag == tag]


def _check_numbers(element: Element) -> None:
    """Refuse an attribute that should be a number and is none, or is larger than any of a map's."""
    for name in element.attributes.keys() - _NO_NUMBERS:
        element.number(name)
    for child in element.children:
        _check_numbers(child)


def _check_references(root: Element) -> None:
    """Refuse a reference to a signal that the file does not have: CARLA's parser does not survive it."""
    marks = [mark for road in _children(root, "road") for row in _children(road, "signals") for mark in row.children]
    known = {mark.text("id") for mark in marks if mark.tag == "signal"}
    for mark in marks:
        if mark.tag == "signalReference" and mark.text("id") not in known:
            raise mark.error(f"id={shown(mark.text('id'))} is no signal of this map")


def _limits(road: Element) -> Iterator[tuple[float, float]]:
    """Yield from where on the road each limit holds [m], and the limit [m/s]."""
    for kind in sorted(_children(road, "type"), key=lambda kind: kind.number("s")):
        for speed in _children(kind, "speed"):
            if (limit := _speed(speed)) is not None:
                yield kind.number("s"), limit


def _lanes(sections: list[Element]) -> Iterator[tuple[Element, Place, Element]]:
    """Yield each lane with its section and place."""
    for number, section in enumerate(sections):
        for side in section.children:
            for lane in _children(side, "lane"):
                yield section, (number, int(lane.number("id"))), lane


def _lane_limits(sections: list[Element]) -> Iterator[tuple[Place, float]]:
    for _, place, lane in _lanes(sections):
        limits = [limit for speed in _children(lane, "speed") if (limit := _speed(speed)) is not None]
        if limits:
            yield place, min(limits)


def _marks(sections: list[Element]) -> Iterator[tuple[Place, tuple[tuple[float, str], ...]]]:
    for section, place, lane in _lanes(sections):
        start = section.number("s")
        marks = [
            (start + mark.number("sOffset", low=0.0), mark.choice("laneChange", _CHANGES, "both"))
            for mark in _children(lane, "roadMark")
        ]
        if marks:
            yield place, tuple(sorted(marks, key=lambda mark: mark[0]))


def _speed(element: Element) -> float | None:
    """Return a limit [m/s], None where there is said to be none."""
    if element.text("max") in ("no limit", "undefined"):
        return None
    unit = element.choice("unit", _UNITS, "m/s")
    return max(element.number("max", low=0.0) * _UNITS[unit], 1.0)


def _priorities(junction: Element) -> Iterator[tuple[int, int]]:
    for each in _children(junction, "priority"):
        if each.attributes.get("high") and each.attributes.get("low"):
            yield each.natural("high"), each.natural("low")


def _in_sequence(junction: Element, lights: Mapping[str, frozenset[str]]) -> Iterator[frozenset[str]]:
    """Yield the lights that each of a junction's controllers switches."""
    controllers = _children(junction, "controller")
    for controller in sorted(controllers, key=lambda each: each.number("sequence", 0.0)):
        if found := lights.get(controller.text("id")):
            yield found
