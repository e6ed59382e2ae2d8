"""Where the plans of a recorded run lead on its map."""

from __future__ import annotations

from typing import Any

from tmpud.events import Header
from tmpud.geometry import Point
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path import outline
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import preset_named
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Place, ServiceRequest, TaskPlan


def mapping_of(network: RoadNetwork, header: Header) -> StateMapping:
    """Return the state mapping f that a run was driven with."""
    mission = header.mission
    words = mission["request"]
    request = ServiceRequest(_place(words["start"]), tuple(_place(goal) for goal in words["goals"]))
    return StateMapping(network, request, preset_named(mission["preset"]), mission["seed"])


def plan_outline(network: RoadNetwork, mapping: StateMapping, plan: TaskPlan) -> list[Point]:
    """Return the points of the path a plan drives."""
    paths = PathPlanner(network, mapping)
    points: list[Point] = []
    for step in plan:
        for move in paths.moves(mapping(step.state), step) or ():
            points += outline(move)
    return points


def _place(words: Any) -> Place:
    return Place(words["name"], tuple(words["segments"]), words["station"])
