"""Let SUMO's own traffic circulate on a map, and report its collisions and whether it got stuck.

    python tools/check_traffic.py millbrook --vehicles 200 --seconds 3600 --seed 1

Prints one JSON object; the exit code is 1 where cars collided or the traffic stands.
Needs sumo, from the extra ``maps``.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tmpud.roads import RoadNetwork, load_map
from tmpud.roads.moves import largest_strong_part
from tmpud.roads.xml_reading import read_xml

SPEED = 5.56  # [m/s] what the drivers wish: 20 km/h
STANDING = 0.5  # [m/s] a town whose cars are slower than this on average is stuck
OPTIONS = """
--step-length=0.05 --collision.action=warn --collision.check-junctions --collision.mingap-factor=0
--time-to-teleport=-1 --max-depart-delay=-1 --no-step-log --no-warnings
--collision-output=collisions.xml --summary-output=summary.xml --summary-output.period=10
"""


def routes(network: RoadNetwork, vehicles: int, seconds: float, rng: random.Random) -> str:
    """Return a SUMO route file of random walks, each too long to end in time; one car departs every 0.5 s."""
    inside = {network.segments[segment].lane for segment in largest_strong_part(network)}
    onward: dict[str, list[str]] = {}
    for connection in network.connections:
        if {connection.from_lane, connection.to_lane} <= inside:
            edge, following = (network.lanes[lane].edge for lane in (connection.from_lane, connection.to_lane))
            if following not in onward.setdefault(edge, []):
                onward[edge].append(following)
    shortest = min(network.lanes[network.edges[edge][0]].length for edge in onward)
    lines = [f'<routes><vType id="car" maxSpeed="{SPEED}"/>']
    for number in range(vehicles):
        walk = [rng.choice(list(onward))]
        while len(walk) < 20 + seconds * SPEED / shortest:
            walk.append(rng.choice([edge for edge in onward[walk[-1]] if edge in onward]))
        lines.append(
            f'<vehicle id="{number}" type="car" depart="{number * 0.5}" departLane="best" departPos="random_free">'
            f'<route edges="{" ".join(walk)}"/></vehicle>'
        )
    return "\n".join([*lines, "</routes>"])


def drive(network: RoadNetwork, vehicles: int, seconds: float, seed: int) -> dict[str, float | int | str]:
    """Simulate and return the figures: collisions, and the mean speed in the last sixth of the time [m/s]."""
    walks = routes(network, vehicles, seconds, random.Random(seed))  # noqa: S311  a seed, not a secret
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "walks.rou.xml").write_text(walks, encoding="utf-8")
        sumo = Path(sys.executable).parent / "sumo"
        command = [str(sumo) if sumo.exists() else "sumo", "-n", network.source, "-r", "walks.rou.xml"]
        command += [*OPTIONS.split(), f"--seed={seed}", f"--end={seconds}"]
        environment = {key: value for key, value in os.environ.items() if value or key != "SUMO_HOME"}
        subprocess.run(command, check=True, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
        crashes = read_xml(folder / "collisions.xml", "collisions", ["collision"])[0].children
        steps = read_xml(folder / "summary.xml", "summary", ["step"])[0].children
    late = [step.number("meanSpeed") for step in steps if step.number("time") >= seconds * 5 / 6]
    return {
        "map": network.name,
        "vehicles": vehicles,
        "running": steps[-1].natural("running"),
        "seconds": seconds,
        "seed": seed,
        "collisions": len({(crash.text("collider"), crash.text("victim")) for crash in crashes}),
        "late_mean_speed": round(sum(late) / len(late), 2),
    }


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("map", help="a shipped town or a net file")
    parser.add_argument("--vehicles", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=3600.0)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args(arguments)
    network = load_map(Path(asked.map).resolve() if os.sep in asked.map else asked.map)
    found = drive(network, asked.vehicles, asked.seconds, asked.seed)
    print(json.dumps(found))
    return int(found["collisions"] != 0 or float(found["late_mean_speed"]) < STANDING)


if __name__ == "__main__":
    sys.exit(main())
