"""Safety estimation: o_i(t) of many vehicles, in closed form and sampled, ours and as others would write it.

    python -m benchmarks safety --vehicles 1 10 50 500 --samples 1000

Each case is a random scene. Everybody predicts the vehicles, works out U_i^S at each instant and its share of
Delta x Theta, with the gate open everywhere, which is the most work there can be; "the share alone" is given U_i^S.
Closed forms must agree to 1e-6, samples with them to 6 standard deviations, at every vehicle and instant.
"""

from __future__ import annotations

import argparse
import math
import random
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.harness import Entry, Result, progress, race
from benchmarks.peers import scalar_safety
from tmpud.dynamics import EGO
from tmpud.presets import TMPUD, Preset
from tmpud.safety.control_set import HalfPlane, controls, half_plane, in_use, safety_index
from tmpud.safety.share import exact_share, sampled_share
from tmpud.scene import FloatArray, Vehicles
from tmpud.trajectory import Trajectory, predict

OURS = "exact (ours)"
INTERVAL = 0.4  # [s] between instants
BUDGET = 1000  # vehicles looked at in all rounds together; pure Python takes seconds for each 500
Share = Callable[[HalfPlane], FloatArray]


@dataclass(frozen=True, slots=True, eq=False)
class SafetyCase:
    """A scene: the ego's trajectory and the vehicles around it."""

    ego: Trajectory
    others: Vehicles


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--vehicles", type=int, nargs="+", default=[1, 10, 50, 500])
    parser.add_argument("--instants", type=int, default=10)
    parser.add_argument("--samples", type=int, default=1000, help="M")
    parser.add_argument("--rounds", type=int, default=100, help="at most; fewer with many vehicles")
    parser.add_argument(
        "--turn", type=float, default=0.005, help="least length of a turn [s]; 0: one call, caches cold"
    )
    parser.add_argument("--seed", type=int, default=1)


def measure(asked: argparse.Namespace) -> list[Result]:
    preset = replace(TMPUD, gate=-math.inf, samples=asked.samples)
    return [among(count, preset, asked) for count in asked.vehicles]


def among(vehicles: int, preset: Preset, asked: argparse.Namespace, *, slow: bool = True) -> Result:
    """Race with some vehicles, against all others or, without ``slow``, among ours alone."""
    rng = np.random.default_rng(asked.seed)
    rounds = max(3, min(asked.rounds, BUDGET // vehicles)) if slow else asked.rounds
    cases = [scene(rng, vehicles, asked.instants) for _ in range(rounds)]
    progress(f"safety: {vehicles} vehicles, {asked.instants} instants, {rounds} rounds")
    times = race([*ours(preset, rng), *(others(preset, asked.seed) if slow else ())], cases, 1, asked.turn)
    title = f"{vehicles} vehicles, {asked.instants} instants, M = {preset.samples}"
    facts = {"vehicles": vehicles, "instants": asked.instants, "samples": preset.samples, "turn_s": asked.turn}
    return Result(title, OURS, times, facts=facts, batch=(vehicles * asked.instants, "shares"))


def scene(rng: np.random.Generator, vehicles: int, instants: int) -> SafetyCase:
    """Return an ego that drives straight on at 8 m/s and vehicles within 30 m that drive anyhow."""
    times: FloatArray = np.arange(instants, dtype=np.float64) * INTERVAL
    poses = np.stack([8.0 * times, np.zeros(instants), np.zeros(instants)], axis=1)
    x, y = rng.uniform(-30, 30, (2, vehicles))
    size = np.ones(vehicles)
    moving = (rng.uniform(-np.pi, np.pi, vehicles), rng.uniform(0, 14, vehicles), rng.normal(0, 0.1, vehicles))
    names = tuple(map(str, range(vehicles)))
    columns = (x, y, 0 * size, *moving, 0 * size, 4.7 * size, 1.9 * size)
    around = Vehicles.of_table(names, ("",) * vehicles, np.stack(columns, axis=1))
    return SafetyCase(Trajectory(times, poses, np.full(instants, 8.0)), around)


def ours(preset: Preset, rng: np.random.Generator) -> list[Entry[SafetyCase]]:
    """Return what the estimator does, in closed form and by sampling."""
    ranges, tolerance = controls(preset), deviation(preset.samples)

    def exact(plane: HalfPlane) -> FloatArray:
        return exact_share(plane, ranges)

    def sampled(plane: HalfPlane) -> FloatArray:
        return sampled_share(plane, ranges, preset.samples, rng)

    def whole(share: Share) -> Callable[[SafetyCase], Callable[[], Any]]:
        return lambda case: lambda: share(planes(case, preset))

    def alone(case: SafetyCase) -> Callable[[], Any]:
        given = planes(case, preset)
        return lambda: exact(given)

    return [
        Entry(OURS, whole(exact)),
        Entry("exact, the share alone (ours)", alone, 1e-6),
        Entry("sampled (ours)", whole(sampled), tolerance),
    ]


def others(preset: Preset, seed: int) -> list[Entry[SafetyCase]]:
    """Return one vehicle and instant after the other."""
    tolerance = deviation(preset.samples)
    shares = {
        "exact, pure Python": (scalar_safety.exact, 1e-6),
        "sampled, numpy for each": (scalar_safety.sampled_in_rows(np.random.default_rng(seed)), tolerance),
        "sampled, pure Python": (scalar_safety.sampled(random.Random(seed)), tolerance),  # noqa: S311
    }

    def work(share: Any) -> Callable[[SafetyCase], Callable[[], Iterable[float]]]:
        return lambda case: lambda: scalar_safety.shares(case.ego, case.others, preset, share)

    return [Entry(name, work(share), error) for name, (share, error) in shares.items()]


def planes(case: SafetyCase, preset: Preset) -> HalfPlane:
    """Return U_i^S of every vehicle and instant in one row (Alg. 1, lines 3 to 5)."""
    index = safety_index(case.ego, case.others, predict(case.others, case.ego.times), preset)
    return half_plane(index, case.ego, preset, EGO.wheelbase).at(in_use(index, case.ego, preset))


def deviation(samples: int) -> float:
    """Return six standard deviations of a share that was sampled."""
    return 6 * math.sqrt(0.25 / samples)
