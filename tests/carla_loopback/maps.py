"""Where vehicles start and lights stand on a map: read by CARLA's own parser, which needs no server."""

from __future__ import annotations

from typing import Any

import carla

from tests.carla_loopback.lights import Light

SPACING = 15.0  # [m] between spawn points
BEFORE = 0.5  # [m] a light is looked for so much before its lane's end
LIGHT = "1000001"  # OpenDRIVE's type of a light with three heads


def spawn_points(name: str, xodr: str) -> list[Any]:
    """Return points on the lanes outside of junctions, lifted as CARLA's are."""
    places = [w.transform for w in carla.Map(name, xodr).generate_waypoints(SPACING) if not w.is_junction]
    return [
        [[p.location.x, p.location.y, p.location.z + 0.5], [p.rotation.pitch, p.rotation.yaw, p.rotation.roll]]
        for p in places
    ]


def lights(name: str, xodr: str) -> list[Light]:
    """Return one head for each light's id; those of one junction that face across take turns."""
    town = carla.Map(name, xodr)
    marks = {mark.id: mark for mark in town.get_all_landmarks_of_type(LIGHT)}
    return [_light(town, marks[sign]) for sign in sorted(marks)]


def _light(town: carla.Map, mark: carla.Landmark) -> Light:
    first, _ = mark.get_lane_validities()[0]
    lane = town.get_waypoint_xodr(mark.road_id, first, max(mark.s - BEFORE, BEFORE))
    place = lane.transform if lane else mark.transform
    return Light(mark.id, place.location.x, place.location.y, place.rotation.yaw, round(place.rotation.yaw / 90.0) % 2)
