"""Let the traffic of a trial circulate on a map without our ego, and report its collisions and whether it got stuck.

    python tools/check_traffic.py millbrook --vehicles 200 --seconds 3600 --seed 1

It is the traffic of the town's paper mission; on other maps it goes everywhere. Prints one JSON object; the exit code
is 1 where cars collided or the traffic stands.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from tmpud.roads import RoadNetwork, load_map
from tmpud.roads.places import request
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.simulators.conventions import DT
from tmpud.simulators.sumo import SumoSimulator

STANDING = 0.5  # [m/s] a town whose cars are slower than this on average is stuck
WAITING = 0.1  # [m/s] a car slower than this stands
SAMPLED = 10.0  # [s] between looks at all cars


class WatchedSumo(SumoSimulator):
    """The trials' simulator; SUMO tells of collisions, and lets them happen."""

    collision_action = "warn"

    def watch(self, seconds: float) -> dict[str, float | int]:
        """Let time pass; return collisions, and mean speed [m/s] and share of cars that stand in the last sixth."""
        crashes: set[tuple[str, str]] = set()
        speeds: list[float] = []
        for step in range(round(seconds / DT)):
            self._advance()
            crashes |= {(crash.collider, crash.victim) for crash in self._sumo.simulation.getCollisions()}
            if step % round(SAMPLED / DT) == 0 and step * DT >= seconds * 5 / 6:
                speeds += self.everyone().speed.tolist()
        return {
            "running": len(self.everyone()),
            "collisions": len(crashes),
            "late_mean_speed": round(sum(speeds) / len(speeds), 2),
            "late_standing": round(sum(speed < WAITING for speed in speeds) / len(speeds), 2),
        }


def drive(network: RoadNetwork, vehicles: int, seconds: float, seed: int) -> dict[str, float | int | str]:
    """Simulate and return the figures."""
    mission = PAPER_MISSIONS.get(network.name)
    there = request(network, mission.start, (mission.goal,)) if mission else None
    with WatchedSumo(network, traffic=vehicles, seed=seed, warm_up=0.0, request=there) as town:
        found = town.watch(seconds)
    return {"map": network.name, "vehicles": vehicles, "seconds": seconds, "seed": seed, **found}


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
