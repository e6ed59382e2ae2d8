"""What CARLA's own client says of a map, as JSON on stdout: ``python -m tests.roads.opendrive.oracle FILE``."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

Facts = dict[str, Any]


@cache
def facts(file: Path) -> Facts:
    """Ask in a child process: not all that the client is asked here ends well on every map."""
    command = [sys.executable, "-m", "tests.roads.opendrive.oracle", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found: Facts = json.loads(done.stdout)
    return found


def _ask(file: Path) -> Facts:
    import carla

    town = carla.Map("town", file.read_text(encoding="utf-8"))
    topology = [(_key(here), _key(there)) for here, there in town.get_topology()]
    ends = {_key(end): end for pair in town.get_topology() for end in pair}
    return {
        "topology": topology,
        "junctions": {key: end.junction_id for key, end in ends.items() if end.is_junction},
        "waypoints": [_waypoint(each) for each in town.generate_waypoints(1.0)],
        "marks": [(mark.id, mark.type, mark.road_id, mark.get_lane_validities()) for mark in town.get_all_landmarks()],
    }


def _key(waypoint: Any) -> str:
    return f"{waypoint.road_id}.{waypoint.section_id}.{waypoint.lane_id}"


def _waypoint(here: Any) -> Facts:
    """Return where a waypoint is, and to which lanes beside it that lead the same way one may change.

    A mark that lets cars change one way only is "one-way": the client takes it to be about the traffic's direction,
    where OpenDRIVE means the change's.
    """
    place = here.transform.location
    beside: dict[str, str] = {}
    sides = () if here.is_junction else ("left", "right")
    for side in sides:
        flag, there = {"left": 2, "right": 1}[side], getattr(here, f"get_{side}_lane")()
        if there and str(there.lane_type) == "Driving" and there.lane_id * here.lane_id > 0:
            mark = int(getattr(here, f"{side}_lane_marking").lane_change)
            beside[side] = "one-way" if mark in (1, 2) else _key(there) if here.lane_change & flag else ""
    return {"lane": _key(here), "at": (place.x, place.y, place.z), "width": here.lane_width, "beside": beside}


if __name__ == "__main__":
    print(json.dumps(_ask(Path(sys.argv[1]))))  # noqa: T201
