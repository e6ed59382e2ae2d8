"""Sections that need no simulator: plans, estimates, damaged nets, turns."""

from __future__ import annotations

import gzip
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from tests.judging.agreement import compare_boxes_with_shapely
from tests.motion.turns import drive_every_turn
from tests.roads.mutations import fuzz
from tests.safety.agreement import (
    compare_exact_with_polygon,
    compare_exact_with_quadrature,
    compare_sampled_with_exact,
)
from tests.task.agreement import Tally, compare
from tests.task.ruled import compare as compare_ruled
from tmpud.dynamics import EGO
from tmpud.experiments.running.progress import Progress
from tmpud.roads.loading import load_map, map_file
from tools.verification.figures import Figure, none_in
from tools.verification.options import Options, map_name

CHUNK = 50  # cases between two lines of progress
MOST_OFF = 0.3  # [m] RMS of the centre's distance from the map's own path
MOST_SPEED = EGO.max_speed + 0.1  # [m/s]
MOST_SIDEWAYS = EGO.max_lateral_acceleration


def plans(options: Options) -> list[Figure]:
    """Check clingo, with and without pruning, against Dijkstra and enumeration on random road graphs."""
    planners = "clingo (pruned, whole map) = search = Dijkstra = enumeration"
    ruled = "clingo (pruned and widened, whole map) = enumeration"
    return [
        _agreement(f"optimal plans: {planners}, one goal and several, 3 presets", options.graphs, compare),
        _agreement(f"optimal plans under a user's rules: {ruled}", options.graphs // 5, compare_ruled),
    ]


def _agreement(what: str, total: int, compare: Callable[[int, int], Tally]) -> Figure:
    tally = Tally()
    for seed in Progress("plans", total).over(range(1, -(-total // CHUNK) + 1), CHUNK):
        tally.add(compare(min(CHUNK, total - tally.graphs), seed))
    wrong = len(tally.mismatches)
    counts = f"{tally.plans:,} plans, {tally.enumerated:,} also by enumeration, {tally.without_plan:,} without any plan"
    return Figure(
        what=what,
        n=tally.graphs,
        result=f"{wrong or none_in(tally.plans)} mismatches; {counts}",
        target="0 mismatches",
        holds=not wrong,
        seed=1,
        details={"mismatches": tally.mismatches[:20]},
    )


def estimates(options: Options) -> list[Figure]:
    """Check the share of safe controls against quadrature, shapely and sampling, and boxes against shapely."""
    n, few = options.cases, max(options.cases // 200, 1)
    progress = Progress("estimates", 4)
    quadrature = compare_exact_with_quadrature(n, seed=1)
    progress.step()
    polygon = compare_exact_with_polygon(n, seed=2)
    progress.step()
    sampled = compare_sampled_with_exact(few, seed=3)
    progress.step()
    wrong, overlaps = compare_boxes_with_shapely(n, seed=4)
    progress.step()
    return [
        _error("exact share = quadrature, half steering up to +-0.6 rad, half yaw rates", n, quadrature, 1e-9, 1),
        _error("exact share = area of a polygon cut by shapely, yaw rates", n, polygon, 1e-9, 2),
        _error("share of 1,000,000 samples = exact share", few, sampled, 0.002, 3),
        Figure(
            what="overlap of oriented boxes = shapely",
            n=n,
            result=f"{wrong or none_in(n)} wrong; {overlaps:,} overlap",
            target="0 wrong",
            holds=not wrong,
            seed=4,
        ),
    ]


def _error(what: str, n: int, error: float, most: float, seed: int) -> Figure:
    return Figure(
        what, n, f"largest error {error:.1e}", f"at most {most:g}", bool(error <= most), seed, {"error": error}
    )


def nets(options: Options) -> list[Figure]:
    """Check that damaged maps are refused in one line or sound."""
    return [_damaged(source, options.mutants) for source in options.maps]


def _damaged(source: str, n: int) -> Figure:
    file = map_file(source)
    net = gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes()
    outcomes: Counter[str] = Counter()
    others, slowest = [], (0.0, 0)
    with tempfile.TemporaryDirectory() as folder:
        for seed in Progress(f"nets {map_name(source)}", n).over(range(1, n + 1)):
            began = time.monotonic()
            try:
                outcomes += fuzz(net, 1, seed, Path(folder))
            except Exception as error:
                others.append(f"seed {seed}: {type(error).__name__}: {error}"[:300])
            slowest = max(slowest, (time.monotonic() - began, seed))
    counts = f"{outcomes['refused']} refused in one line, {outcomes['valid']} valid"
    return Figure(
        what=f"damaged copies of {map_name(source)}: MapError or a sound map",
        n=n,
        result=f"{counts}, {len(others) or none_in(n)} other; slowest {slowest[0]:.1f} s (seed {slowest[1]})",
        target="0 other, none over 10 s",
        holds=not others,
        seed=1,
        details={"others": others[:20]},
    )


def turns(options: Options) -> list[Figure]:
    """Check how well every turn of a map is driven without traffic."""
    return [_turns(source) for source in Progress("turns", len(options.maps)).over(options.maps)]


def _turns(source: str) -> Figure:
    driven = drive_every_turn(load_map(source))
    rms = max(driven, key=lambda turn: turn.rms)
    sideways = max(driven, key=lambda turn: turn.lateral_acceleration)
    speed = max(turn.speed for turn in driven)
    return Figure(
        what=f"every left and right turn of {map_name(source)}, driven without traffic",
        n=len(driven),
        result=f"worst RMS {rms.rms:.2f} m ({rms.turn}), lateral {sideways.lateral_acceleration:.2f} m/s^2, "
        f"speed {speed:.2f} m/s",
        target=f"RMS at most {MOST_OFF:g} m, lateral {MOST_SIDEWAYS:g} m/s^2, speed {MOST_SPEED:.2f} m/s",
        holds=rms.rms <= MOST_OFF and sideways.lateral_acceleration <= MOST_SIDEWAYS and speed <= MOST_SPEED,
        seed=0,
        details={"too_far_off": [turn.turn for turn in driven if turn.rms > MOST_OFF]},
    )
