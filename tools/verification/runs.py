"""Sections about whole runs: repeated missions, and SUMO's own traffic."""

from __future__ import annotations

import hashlib
import tempfile
from itertools import cycle, islice
from pathlib import Path

from tmpud.experiments.running.progress import Progress
from tmpud.recording import LOG
from tmpud.roads import load_map, shipped_towns
from tools.check_traffic import STANDING
from tools.check_traffic import drive as circulate
from tools.verification.figures import Figure, none_in
from tools.verification.options import Options
from tools.verification.trials import drive, each

FIRST_SEED = 2000
HASH_SEEDS = "1", "20240607"
VEHICLES = 120, 200


def repeat(options: Options) -> list[Figure]:
    """Drive missions twice, in fresh processes with other hash seeds: the logs are the same, byte for byte."""
    seeds = range(FIRST_SEED, FIRST_SEED + options.repeats)
    algorithms = dict(zip(seeds, islice(cycle(("tmpud", "no-com", "threshold")), options.repeats), strict=True))
    logs: dict[int, set[str]] = {seed: set() for seed in seeds}
    missing = []
    progress = Progress("repeat", 2 * options.repeats)
    with tempfile.TemporaryDirectory() as folder:

        def run(work: tuple[int, str]) -> str | None:
            """Return a digest of the run's log."""
            seed, hash_seed = work
            places = ["--from", "random", "--to", "random", "--seed", str(seed), f"--traffic={options.traffic}"]
            trial = drive(
                Path(folder) / f"{seed}-{hash_seed}",
                [*places, "--algorithm", algorithms[seed]],
                {"PYTHONHASHSEED": hash_seed},
            )
            log = trial.folder / LOG
            return hashlib.sha256(log.read_bytes()).hexdigest() if log.exists() else None

        for (seed, _), digest in each(run, [(seed, other) for seed in seeds for other in HASH_SEEDS]):
            progress.step()
            if digest is None:
                missing.append(seed)
            else:
                logs[seed].add(digest)
    different = [seed for seed, digests in logs.items() if len(digests) > 1 or seed in missing]
    return [
        Figure(
            what=f"the same mission run twice on {', '.join(shipped_towns()[:1])}: event logs equal byte for byte",
            n=options.repeats,
            result=f"{len(different) or none_in(options.repeats)} different"
            + (f": seeds {', '.join(map(str, different))}" if different else ""),
            target="0 different",
            holds=not different,
            seed=FIRST_SEED,
            details={"hash_seeds": HASH_SEEDS, "different": different, "without_log": missing},
        )
    ]


def traffic(options: Options) -> list[Figure]:
    """Let SUMO's own cars circulate on the shipped towns: none may collide, and they must not get stuck."""
    work = [(town, vehicles) for town in shipped_towns() for vehicles in VEHICLES]
    progress = Progress("traffic", len(work))
    return [_circulation(town, vehicles, options.seconds) for town, vehicles in progress.over(work)]


def _circulation(town: str, vehicles: int, seconds: float) -> Figure:
    found = circulate(load_map(town), vehicles, seconds, seed=1)
    collisions, speed = int(found["collisions"]), float(found["late_mean_speed"])
    return Figure(
        what=f"SUMO's own traffic on {town}, {vehicles} vehicles, {seconds:g} simulated s",
        n=vehicles,
        result=f"{collisions} collisions; mean speed at the end {speed:.2f} m/s",
        target=f"0 collisions, at least {STANDING:g} m/s",
        holds=not collisions and speed >= STANDING,
        seed=1,
        details=found,
    )
