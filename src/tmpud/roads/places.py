"""Starts and goals as users write them: a lane, a road, a position, or ``random``."""

from __future__ import annotations

import difflib
import random
import re
from collections.abc import Iterable, Sequence

from tmpud.errors import RequestError
from tmpud.roads.moves import largest_strong_part, reachable
from tmpud.roads.network import RoadNetwork
from tmpud.roads.xml_reading import shown
from tmpud.symbols import Place, ServiceRequest

SNAP = 10.0  # [m] a position may be this far from the centre line of a lane
RANDOM = "random"
_NUMBER = r"\s*([+-]?(?:\d{1,9}\.?\d{0,20}|\.\d{1,20}))\s*"
_POSITION = re.compile(f"{_NUMBER},{_NUMBER}", re.ASCII)


def request(
    network: RoadNetwork, start: str, goals: Sequence[str], vias: Sequence[str] = (), seed: int = 0
) -> ServiceRequest:
    """Return the request to drive from a start by way of some places to the goals, all in their order.

    Random places are drawn with the seed; random goals are such as can be reached from the start.
    Raises RequestError where a place is not on the map.
    """
    rng = random.Random(seed)  # noqa: S311  a mission's seed, not a secret
    first = resolve(network, start, rng)
    stops = tuple(resolve(network, text, rng, reachable_from=first.segments[:1]) for text in (*vias, *goals))
    if not stops:
        raise RequestError("a request needs a goal")
    return ServiceRequest(first, stops)


def resolve(
    network: RoadNetwork, text: str, rng: random.Random, *, reachable_from: Iterable[str] | None = None
) -> Place:
    """Return the place that a text names: a lane id, else an edge id, else ``x,y`` [m], else ``random``.

    A lane means all its segments in driving order, an edge those of all its lanes, the rightmost first; a position
    means the nearest lane's. ``random`` is uniform over the length of the map's largest strongly connected part,
    as far as that can be reached from some segments, where these are given. Raises RequestError.
    """
    if text in network.lanes:
        return Place(text, tuple(segment.id for segment in network.segments_of(text)))
    if text in network.edges:
        row = network.edges[text]
        return Place(text, tuple(segment.id for lane in row for segment in network.segments_of(lane)))
    if position := _POSITION.fullmatch(text):
        return _snapped(network, text, float(position[1]), float(position[2]))
    if text == RANDOM:
        return _drawn(network, rng, reachable_from)
    raise RequestError(_unknown(network, text))


def _snapped(network: RoadNetwork, text: str, x: float, y: float) -> Place:
    lane, station, _ = network.locate(x, y)
    nearest = lane.centre.pose_at(station)
    distance = ((nearest.x - x) ** 2 + (nearest.y - y) ** 2) ** 0.5
    if distance > SNAP:
        where = f"at {nearest.x:.1f},{nearest.y:.1f}"
        raise RequestError(
            f"{text} is not on a road of {network.name}: the nearest lane, {lane.id}, is {distance:.1f} m away {where}"
        )
    return Place(text, (network.segment_at(lane.id, station).id,), station)


def _drawn(network: RoadNetwork, rng: random.Random, reachable_from: Iterable[str] | None) -> Place:
    part = largest_strong_part(network)
    within = part if reachable_from is None else part & reachable(network, reachable_from)
    segments = [segment for segment in network.segments.values() if segment.id in within]
    if not segments:
        raise RequestError(f"no random goal on {network.name} can be reached from the start")
    drawn = rng.choices(segments, weights=[segment.end - segment.start for segment in segments])[0]
    return Place(RANDOM, (drawn.id,), rng.uniform(drawn.start, drawn.end))


def _unknown(network: RoadNetwork, text: str) -> str:
    known = [*network.lanes, *network.edges]
    close = difflib.get_close_matches(text, known, n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(close)}?" if close else f"lanes are named like {known[0]}"
    return f"{shown(text)} is not a lane, edge, position x,y or 'random' on {network.name}; {hint}"
