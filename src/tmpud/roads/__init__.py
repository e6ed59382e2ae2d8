"""Road maps: reading, cutting into lane segments, naming places, counting."""

from tmpud.roads.loading import load_map, shipped_towns
from tmpud.roads.network import RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net

__all__ = ["RoadNetwork", "load_map", "read_sumo_net", "shipped_towns"]
