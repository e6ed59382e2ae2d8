"""The map of a recorded run, and where its plans lead on it."""

from __future__ import annotations

from typing import Any

from tmpud.errors import TmpudError
from tmpud.events import Header
from tmpud.geometry import Point
from tmpud.motion.mapping import StateMapping
from tmpud.motion.path import outline
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import preset_named
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Place, ServiceRequest, TaskPlan
from tmpud.viewer.intact import Intact


class Outlines:
    """The paths of a run's plans on its map; what cannot be drawn is added to the run's ``missing``."""

    def __init__(self, run: Intact) -> None:
        self.network = _network(run)
        try:
            self._mapping = mapping_of(self.network, run.header) if self.network else None
        except (TmpudError, KeyError, TypeError, ValueError):
            self._mapping = None
            run.missing.append("the request in the header cannot be read, so no plan is drawn on the map")

    def __call__(self, plan: TaskPlan) -> list[Point]:
        """Return the points of the path a plan drives; none where the map does not have it."""
        network, mapping = self.network, self._mapping
        if network is None or mapping is None:
            return []
        named = {segment for step in plan for segment in (step.state.segment, step.next_state.segment)}
        return plan_outline(network, mapping, plan) if named <= network.segments.keys() else []


def _network(run: Intact) -> RoadNetwork | None:
    """Return the map a run was driven on, None where it is not there any more or is another one."""
    mission, town = run.header.mission, run.header.map
    try:
        network = load_map(str(mission["map"]), preset_named(str(mission["preset"])).segment_length)
    except (TmpudError, OSError, KeyError, ValueError) as error:
        run.missing.append(f"the map cannot be read, so no roads are drawn: {error}")
        return None
    if network.digest != town.get("digest"):
        run.missing.append(f"{mission['map']} is not the map it was when this was driven, so no roads are drawn")
        return None
    return network


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
