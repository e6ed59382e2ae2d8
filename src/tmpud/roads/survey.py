"""How big a map is, and what can be done on it: what ``tmpud map info`` prints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from tmpud.roads.moves import largest_strong_part, moves
from tmpud.roads.network import RoadNetwork
from tmpud.symbols import Action


@dataclass(frozen=True, slots=True)
class Survey:
    """Counts of one map; only what is open to cars is counted."""

    name: str
    segments: int
    lanes: int
    lane_km: float  # [km]
    edges: int
    junctions: int
    signals: int  # junctions' lights
    connections: int
    transitions: Mapping[Action, int]  # moves from segment to segment
    unreachable: float  # [0, 1] share of segments outside the largest strongly connected part
    warnings: tuple[str, ...]


def survey(network: RoadNetwork) -> Survey:
    """Count what a map has."""
    counts = Counter(move.action for segment in network.segments for move in moves(network, segment))
    return Survey(
        name=network.name,
        segments=len(network.segments),
        lanes=len(network.lanes),
        lane_km=sum(lane.length for lane in network.lanes.values()) / 1000,
        edges=len(network.edges),
        junctions=len(network.junctions),
        signals=len({connection.signal for connection in network.connections if connection.signal}),
        connections=len(network.connections),
        transitions={action: counts[action] for action in Action},
        unreachable=1 - len(largest_strong_part(network)) / len(network.segments),
        warnings=network.warnings,
    )
