"""A small town in OpenDRIVE, written for the tests: a crossing with lights, and a side road with a stop sign.

    West (road 1) ====X==== east (road 2) ====T==== far east (road 5)     X: junction 100, lights; roads 3 and 4 go
                      |                       |                           north and south of it.  T: junction 200;
                                                                          road 6 comes from the south, with a stop sign.

West, east and the crossing have two lanes each way, and bicycle lanes; lanes may be changed
on parts of west, on south to higher and on far east to lower numbers only.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

WIDTH = 3.5  # [m] of a lane
RADIUS = 15.0  # [m] from the middle of a junction to its arms
CONTROLLERS = {"900": ("1", "2"), "901": ("3", "4")}  # lights are named after the road that they face


class Arm(NamedTuple):
    """A road's end at a junction: where it is, and which way one drives on it into the junction."""

    road: int
    contact: str  # which end of the road it is: start or end
    heading: int  # [degrees] of driving in
    lanes: int = 2  # each way


@dataclass
class Section:
    """A lane section: how many lanes each way; ``marks`` say from where on [m] lanes may be changed, and how."""

    start: float = 0.0
    lanes: int = 2
    marks: Sequence[tuple[float, str]] = ((0.0, "both"),)


@dataclass
class Road:
    id: int
    x: float
    y: float
    heading: float  # [degrees]
    length: float
    sections: Sequence[Section] = field(default_factory=lambda: [Section()])
    links: str = ""
    extra: str = ""  # signals
    speed: str = '<speed max="30" unit="mph"/>'
    rise: float = 0.0  # [m/m]


def crossroads() -> str:
    """Return the town's file."""
    crossing = [Arm(1, "end", 0), Arm(2, "start", 180), Arm(3, "start", 270), Arm(4, "end", 90)]
    side = [Arm(2, "end", 0), Arm(5, "start", 180), Arm(6, "end", 90, 1)]
    west = [Section(0.0, 2, ((0.0, "both"), (60.0, "none"))), Section(100.0, 2, ((0.0, "none"), (50.0, "both")))]
    roads = [
        Road(1, -200, 0, 0, 185, west, _links(after=100)),
        Road(2, 15, 0, 0, 170, links=_links(before=100, after=200), rise=0.02),
        Road(3, 0, 15, 90, 120, [Section(), Section(70.0, 3)], _links(before=100)),
        Road(4, 0, -135, 90, 120, [Section(marks=((0.0, "increase"),))], _links(after=100)),
        Road(5, 215, 0, 0, 80, [Section(marks=((0.0, "decrease"),))], _links(before=200), speed=""),
        Road(6, 200, -95, 90, 80, [Section(lanes=1)], _links(after=200)),
    ]
    posts = "".join(_signal(light, "1000001") for lights in CONTROLLERS.values() for light in lights)
    roads[4].extra = f"<signals>{posts}{_signal('60', '206')}</signals>"
    parts = [_road(road) for road in roads]
    for number, x, arms, marks in ((100, 0.0, crossing, "1234"), (200, 200.0, side, "")):
        parts += _connecting(number, x, arms, marks)
    parts += [_controller(name, lights) for name, lights in CONTROLLERS.items()]
    parts += [_junction(100, crossing, CONTROLLERS), _junction(200, side, ())]
    return f"""<?xml version="1.0" standalone="yes"?>
<OpenDRIVE><header revMajor="1" revMinor="4" name="crossroads" version="1.0" north="0" south="0" east="0" west="0">
<geoReference><![CDATA[+proj=tmerc +lat_0=0 +lon_0=0]]></geoReference></header>
{"".join(parts)}</OpenDRIVE>
"""


def _links(before: int | None = None, after: int | None = None) -> str:
    ends = (("predecessor", before), ("successor", after))
    return "".join(f'<{tag} elementType="junction" elementId="{number}"/>' for tag, number in ends if number)


def _road(road: Road, junction: int = -1, shape: str = "<line/>", lanes: str = "") -> str:
    lanes = lanes or "".join(_section(road.sections, i) for i in range(len(road.sections)))
    return f"""<road name="" length="{road.length:.6f}" id="{road.id}" junction="{junction}"><link>{road.links}</link>
<type s="0" type="town">{road.speed}</type><planView><geometry s="0" x="{road.x:.6f}" y="{road.y:.6f}"
 hdg="{math.radians(road.heading):.9f}" length="{road.length:.6f}">{shape}</geometry></planView>
<elevationProfile><elevation s="0" a="0" b="{road.rise}" c="0" d="0"/></elevationProfile>
<lanes><laneOffset s="0" a="0" b="0" c="0" d="0"/>{lanes}</lanes>{road.extra}</road>
"""


def _section(sections: Sequence[Section], place: int) -> str:
    section = sections[place]

    def side(sign: int) -> str:
        rows = [
            _lane(sign * n, _kind(section, n), _across(sections, place, sign * n), section.marks)
            for n in range(1, section.lanes + 2)
        ]
        return "".join(reversed(rows) if sign > 0 else rows)

    return f"""<laneSection s="{section.start}"><left>{side(1)}</left>
<center><lane id="0" type="none" level="false"><roadMark sOffset="0" type="solid" laneChange="none"/></lane></center>
<right>{side(-1)}</right></laneSection>
"""


def _kind(section: Section, lane: int) -> str:
    return "driving" if lane <= section.lanes else "biking"


def _across(sections: Sequence[Section], place: int, lane: int) -> str:
    """Return to which lanes of the sections before and after it a lane of a section is linked."""
    own = abs(lane) if abs(lane) <= sections[place].lanes else 0  # the bicycle lane is the last one
    found = ""
    for tag, other in (("predecessor", place - 1), ("successor", place + 1)):
        if 0 <= other < len(sections) and own <= sections[other].lanes:
            number = own or sections[other].lanes + 1
            found += f'<{tag} id="{number if lane > 0 else -number}"/>'
    return found


def _lane(number: int, kind: str, links: str, marks: Iterable[tuple[float, str]] = ((0.0, "none"),)) -> str:
    lines = "".join(
        f'<roadMark sOffset="{start}" type="{"broken" if change == "both" else "solid"}" laneChange="{change}"/>'
        for start, change in marks
    )
    return f"""<lane id="{number}" type="{kind}" level="false"><link>{links}</link>
<width sOffset="0" a="{WIDTH if kind != "biking" else 1.5}" b="0" c="0" d="0"/>{lines}</lane>
"""


def _ways(arms: Sequence[Arm]) -> Iterator[tuple[Arm, Arm, int, list[int]]]:
    """Yield from, to, by how much one turns [degrees], and the lanes, counted from the middle."""
    for arm in arms:
        for other in arms:
            turn = (other.heading + 180 - arm.heading + 180) % 360 - 180
            if other is arm:
                continue
            both = list(range(1, min(arm.lanes, other.lanes) + 1))
            yield arm, other, turn, {0: both, 90: both[:1], -90: both[-1:]}[turn]


def _number(junction: int, arm: Arm, other: Arm) -> int:
    return junction * 100 + arm.road * 10 + other.road


def _connecting(junction: int, x: float, arms: Sequence[Arm], lights: str) -> Iterator[str]:
    for arm, other, turn, lanes in _ways(arms):
        angle = math.radians(arm.heading)
        length = 2 * RADIUS if turn == 0 else RADIUS * math.pi / 2
        shape = "<line/>" if turn == 0 else f'<arc curvature="{math.copysign(1 / RADIUS, turn)}"/>'
        mark = _reference(str(arm.road), lanes) if str(arm.road) in lights else ""
        if junction == 200 and arm.road == 6:
            mark = _reference("60", lanes)
        road = Road(
            _number(junction, arm, other), x - RADIUS * math.cos(angle), -RADIUS * math.sin(angle), arm.heading, length
        )
        road.links = "".join(
            f'<{tag} elementType="road" elementId="{end.road}" contactPoint="{end.contact}"/>'
            for tag, end in (("predecessor", arm), ("successor", other))
        )
        road.extra = f"<signals>{mark}</signals>"
        rows = "".join(
            _lane(-n, "driving" if n in lanes else "none", _ends(arm, other, n)) for n in range(1, max(lanes) + 1)
        )
        yield _road(road, junction, shape, _one_way(rows))


def _one_way(rows: str) -> str:
    return f"""<laneSection s="0"><center><lane id="0" type="none" level="false"/></center>
<right>{rows}</right></laneSection>
"""


def _ends(arm: Arm, other: Arm, lane: int) -> str:
    into, out = _into(arm) * lane, -_into(other) * lane
    return f'<predecessor id="{into}"/><successor id="{out}"/>'


def _into(arm: Arm) -> int:
    """Return the sign of the lanes on which one drives into the junction."""
    return -1 if arm.contact == "end" else 1


def _signal(name: str, kind: str) -> str:
    return f"""<signal name="" id="{name}" s="1" t="5" zOffset="0" hOffset="0" roll="0" pitch="0" orientation="-"
 dynamic="{"yes" if kind == "1000001" else "no"}" country="OpenDRIVE" type="{kind}" subtype="-1" value="-1" height="1"
 width="1"><validity fromLane="0" toLane="0"/></signal>
"""


def _reference(name: str, lanes: Sequence[int]) -> str:
    return f"""<signalReference id="{name}" s="0.5" t="0" orientation="+">
<validity fromLane="{-lanes[0]}" toLane="{-lanes[-1]}"/></signalReference>
"""


def _controller(name: str, lights: Iterable[str]) -> str:
    controls = "".join(f'<control signalId="{light}" type=""/>' for light in lights)
    return f'<controller name="" id="{name}" sequence="0">{controls}</controller>\n'


def _junction(number: int, arms: Sequence[Arm], controllers: Iterable[str]) -> str:
    links = "".join(
        f'<connection id="{i}" incomingRoad="{arm.road}" connectingRoad="{_number(number, arm, other)}" '
        f'contactPoint="start">'
        + "".join(f'<laneLink from="{_into(arm) * n}" to="{-n}"/>' for n in lanes)
        + "</connection>\n"
        for i, (arm, other, _, lanes) in enumerate(_ways(arms))
    )
    turns = "".join(f'<controller id="{name}" type="0" sequence="{i}"/>' for i, name in enumerate(controllers))
    return f'<junction id="{number}" name="">{links}{turns}</junction>\n'


if __name__ == "__main__":
    print(crossroads())  # noqa: T201
