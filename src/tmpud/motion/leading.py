"""Who is followed: the nearest vehicle ahead whose box reaches into the ego's way."""

from __future__ import annotations

import math
from typing import NamedTuple

from tmpud.geometry import Point, Pose
from tmpud.motion.route import SPACING, Route
from tmpud.scene import Body, Scene

LOOK_AHEAD = 50.0  # [m]
SAME_LEVEL = 3.0  # [m]
SIDE_ROOM = 0.25  # [m] kept free beside the ego
HALVES = (0.5, 0.0, -0.5)
RIM = [(a, b) for a in HALVES for b in HALVES if a or b]  # eight points on a box's rim, in shares of length and width


class Obstacle(NamedTuple):
    """Something ahead on the route that must not be reached."""

    gap: float  # [m] from the ego's front bumper
    speed: float  # [m/s] along the route


def leader(scene: Scene, route: Route, station: float) -> Obstacle | None:
    """Return the nearest vehicle ahead whose box reaches into the ego's way, within LOOK_AHEAD metres."""
    ego = scene.ego
    ahead = range(route.index(station), route.index(station + LOOK_AHEAD + ego.length) + 1)
    rear, speed = math.inf, 0.0
    for place, box in sorted(_near(scene, route, ahead)):
        if place * SPACING > rear + box.length:
            break  # nor do those that follow come before it
        found = _reached(box, route, ahead, place, station, ego.width / 2 + SIDE_ROOM)
        if found and found[0] < rear:
            rear, speed = found
    gap = rear - station - ego.length / 2
    return Obstacle(gap, speed) if gap <= LOOK_AHEAD else None


def _reached(box: Body, route: Route, ahead: range, i: int, station: float, reach: float) -> tuple[float, float] | None:
    """Return the station at which a box begins to reach into the way [m], and its speed along the way [m/s].

    None where it keeps off, or is left behind. The box is near to the route's i-th point.
    """
    nearest, rim = list[int](), list[tuple[float, float]]()
    for x, y in _rim(box):
        i = route.nearest(x, y, ahead, i)
        along, across = route.beside(x, y, i)
        nearest.append(i)
        rim.append((i * SPACING + along, across))
    stations, offsets = zip(*rim, strict=True)
    if max(stations) <= station or min(offsets) >= reach or max(offsets) <= -reach:
        return None
    middle = sum(stations) / len(stations)
    turned = box.heading - route.poses[nearest[0]].heading
    return min(s if abs(d) < reach else middle for s, d in rim), max(box.speed * math.cos(turned), 0.0)


def _near(scene: Scene, route: Route, ahead: range) -> list[tuple[int, Body]]:
    """Return the vehicles on the ego's level that may reach into the way ahead, with the point at which it comes near.

    These are all that do, and perhaps a few more.

    From a place to which a box keeps some metres, the way takes as many to come up to it: so far it need not be looked
    at. The box is first taken for its circle, then kept from the straight line that goes on from the place.
    """
    poses, hypot, room = route.poses, math.hypot, scene.ego.width / 2 + SIDE_ROOM + SPACING
    near: list[tuple[int, Body]] = []
    for box in scene.others.bodies:
        x, y, z, _, _, _, _, length, width = box
        circle = hypot(length, width) / 2 + room
        here, end = ahead.start, ahead.stop if abs(z - scene.ego.z) < SAME_LEVEL else 0
        while here < end:
            place = poses[here]
            off = hypot(x - place[0], y - place[1]) - circle
            if off < 0.0:
                off = _beside_line(place, box) - room
                if off < 0.0:
                    near.append((here, box))
                    break
            here += 1 + int(off / SPACING)
    return near


def _beside_line(line: Pose, box: Body) -> float:
    """Return how far a box keeps from a straight line [m], negative where it reaches over it."""
    (x, y, heading), turn = line, box.heading - line.heading
    across = abs((box.y - y) * math.cos(heading) - (box.x - x) * math.sin(heading))
    return across - (box.length * abs(math.sin(turn)) + box.width * abs(math.cos(turn))) / 2


def _rim(box: Body) -> list[Point]:
    """Return points on the rim of a box."""
    cos, sin = math.cos(box.heading), math.sin(box.heading)
    ends = [(a * box.length, b * box.width) for a, b in RIM]
    return [(box.x + ahead * cos - left * sin, box.y + ahead * sin + left * cos) for ahead, left in ends]
