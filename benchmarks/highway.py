"""highway-env's steps beside ours: what a second of traffic costs in another simulator of about as many vehicles.

    python -m benchmarks highway --vehicles 50 --steps 500 --rounds 3

highway-env's scene (highway-v0) is a straight road of four lanes without lights or junctions, its ego keeps lane and
speed, and its step is set to ours, 0.05 s. It is skipped where it is not installed.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

from benchmarks import full_step
from benchmarks.full_step import PEERS, Peer, Tape, Turn
from benchmarks.harness import Result, SkipError, need
from tmpud.runner import Mission

STACK = "stack (ours)"
IDLE = 1  # the ego's action: keep lane and speed
RATE = 20  # [1/s] steps


def options(parser: argparse.ArgumentParser) -> None:
    full_step.options(parser)
    parser.set_defaults(vehicles=50, steps=500)


def measure(asked: argparse.Namespace) -> list[Result]:
    peers: dict[str, Peer] = {name: PEERS[name] for name in ("libsumo", STACK)}
    skipped = {}
    try:
        need("highway_env")
        peers["highway-env"] = highway
    except SkipError as reason:
        skipped["highway-env"] = str(reason)
    return [replace(full_step.among(peers, STACK, asked), skipped=skipped)]


def highway(mission: Mission, played: Tape, turn: Turn) -> None:
    """Step as many vehicles as the mission's; after a collision, begin anew."""
    import gymnasium
    import highway_env

    gymnasium.register_envs(highway_env)
    rates = {"simulation_frequency": RATE, "policy_frequency": RATE}
    env = gymnasium.make("highway-v0", config={**rates, "vehicles_count": mission.traffic, "duration": math.inf})
    env.reset(seed=mission.seed)
    for _ in played.steps:
        turn()
        ended = env.step(IDLE)[2]
        if ended:
            env.reset()
    turn()
