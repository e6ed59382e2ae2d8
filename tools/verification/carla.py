"""Sections about CARLA's real client on the loopback server of the tests: never about CARLA's own server."""

from __future__ import annotations

import hashlib
import os
import random
import signal
import tempfile
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests.carla_loopback.running import Loopback, loopback
from tests.carla_loopback.town import default_settings
from tests.carla_loopback.towns import as_opendrive
from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.experiments.running.progress import Progress
from tmpud.experiments.running.tasks import SIM_HANG
from tmpud.roads import load_map
from tmpud.roads.loading import map_file
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.scene import Control
from tmpud.simulators.carla.session import Address
from tmpud.simulators.carla.simulator import CarlaSimulator
from tools.verification.figures import Figure, none_in
from tools.verification.options import Options
from tools.verification.trials import Trial, drive, each

TOWN = "millbrook"
LABEL = "loopback kinematic server, CARLA's client"
STEPS = 200
FIRST_SEED = 3000
VEHICLES = 120, 200
FEW = 10  # vehicles where it is how a session ends that counts
ENDS = "closed", "client killed", "Traffic Manager aborted", "ego vanished"


class Work(NamedTuple):
    vehicles: int
    seed: int


@contextmanager
def serving() -> Iterator[Loopback]:
    """Serve the shipped town for the time of the block."""
    with tempfile.TemporaryDirectory() as folder, loopback(as_opendrive(map_file(TOWN), Path(folder))) as server:
        yield server


def repeat(options: Options) -> list[Figure]:
    """Drive with one seed on fresh servers: the same positions."""
    progress = Progress("carla-repeat", options.repeats)
    hashes = [_positions(options.traffic) for _ in progress.over(range(options.repeats))]
    return [
        Figure(
            what=f"{LABEL}: one seed on fresh servers, {options.traffic} vehicles, {STEPS} steps, hashes of positions",
            n=options.repeats,
            result=f"{len(set(hashes))} hashes",
            target="1 hash",
            holds=len(set(hashes)) == 1,
            seed=FIRST_SEED,
            details={"hashes": dict(Counter(hashes))},
        )
    ]


def _positions(vehicles: int) -> str:
    told = hashlib.sha256()
    with serving() as server, _town(server, vehicles, FIRST_SEED) as town:
        for _ in range(STEPS):
            scene = town.step(Control(0.5, 0.0))
            cars = town.everyone()
            told.update(np.stack([cars.x, cars.y, cars.heading, cars.speed]).tobytes())
            told.update(np.array(scene.ego.pose).tobytes())
    return told.hexdigest()[:16]


def _town(server: Loopback, vehicles: int, seed: int) -> CarlaSimulator:
    town = CarlaSimulator(load_map(TOWN), traffic=vehicles, seed=seed, server=Address(port=server.port), warm_up=1.0)
    town.reset(PAPER_MISSIONS[TOWN].start, 20.0)
    return town


def left(options: Options) -> list[Figure]:
    """End sessions in all ways on one server: it is left as it was found, and the next session works."""
    rng = random.Random(FIRST_SEED)  # noqa: S311
    ends = [rng.choice(ENDS) for _ in range(options.kills)]
    notes, seen = [], Counter[str]()
    progress = Progress("carla-left", len(ends))
    with serving() as server:
        for number, asked in enumerate(progress.over(ends)):
            try:
                end = _ended(server, asked, rng.randrange(1, 20))
                trouble = _found(server)
            except SimulatorError as error:
                end, trouble = asked, f"did not work: {error}"
            seen[end] += 1
            if trouble:
                notes.append(f"{number} ({end}): {trouble}")
    return [
        Figure(
            what=f"{LABEL}: sessions ended ({_counted(seen)}); settings restored, none of our actors left",
            n=len(ends),
            result=f"{len(notes) or none_in(len(ends))} not left as found",
            target="0",
            holds=not notes,
            seed=FIRST_SEED,
            details={"ends": dict(seen), "notes": notes[:20]},
        )
    ]


def _counted(seen: Counter[str]) -> str:
    return ", ".join(f"{count} {end}" for end, count in sorted(seen.items()))


def _ended(server: Loopback, end: str, steps: int) -> str:
    """Let one session end after some steps; return how it did. SimulatorError where it did not get so far."""
    struck = False
    try:
        with _town(server, FEW, FIRST_SEED) as town:
            for step in range(steps + 5):
                if step == steps and end != "closed":
                    _strike(server, town, end)
                    struck = True
                town.step(Control(0.5, 0.0))
    except SimulatorHangError:  # CARLA's client does so now and then by itself
        return "client hung"
    except SimulatorError:
        if not struck:
            raise
    finally:
        server.arm(nonsense_at=10**9, vanish_at=10**9)
    return end


def _found(server: Loopback) -> str:
    """Return in what the server is not as it was found, "" for nothing."""
    report = server.report()
    actors = report["actors"].get("vehicle", 0) + report["actors"].get("sensor", 0)
    settings = "" if report["settings"] == default_settings() else f"settings are {report['settings']}"
    return f"{actors} actors left" if actors else settings


def _strike(server: Loopback, town: CarlaSimulator, end: str) -> None:
    if end == "client killed":
        os.kill(town.process, signal.SIGKILL)
    elif end == "Traffic Manager aborted":
        server.arm(nonsense_at=1)
    elif end == "ego vanished":
        server.arm(vanish_at=1, vanish=1)


def missions(options: Options) -> list[Figure]:
    """Drive random missions among normal and heavy traffic."""
    work = [Work(*row) for row in product(VEHICLES, range(FIRST_SEED, FIRST_SEED + options.carla_missions))]
    hung: list[Work] = []
    done: dict[Work, Trial] = {}
    progress = Progress("carla-missions", len(work))
    with tempfile.TemporaryDirectory() as folder:

        def run(item: Work) -> Trial:
            places = ["--map", TOWN, "--from", "random", "--to", "random", "--seed", str(item.seed)]
            with serving() as server:
                where = ["--sim", "carla", "--port", str(server.port), f"--traffic={item.vehicles}", "--no-frames"]
                trial = drive(Path(folder) / f"{item.vehicles}-{item.seed}", [*places, *where])
                if trial.status != SIM_HANG:
                    return trial
                hung.append(item)  # CARLA's client does so now and then by itself; tried anew, as in an experiment
                return drive(Path(folder) / f"{item.vehicles}-{item.seed}-anew", [*places, *where])

        for item, trial in each(run, work):
            done[item] = trial
            progress.step(note=f"{item.vehicles} vehicles, {item.seed}: {trial.status}")
    return [
        _missions(
            vehicles,
            {item.seed: done[item] for item in sorted(done) if item.vehicles == vehicles},
            [item.seed for item in hung if item.vehicles == vehicles],
        )
        for vehicles in VEHICLES
    ]


def _missions(vehicles: int, trials: dict[int, Trial], hung: list[int]) -> Figure:
    statuses = Counter(trial.status for trial in trials.values())
    driven = statuses["SUCCESS"] + statuses["COLLISION"] + statuses["STOPPED_BLOCKED"] + statuses["TIME_LIMIT"]
    return Figure(
        what=f"{LABEL}: random missions on {TOWN}, {vehicles} vehicles",
        n=len(trials),
        result=f"{_counted(statuses)}; driven anew after the client hung: {len(hung)}",
        target="each ends as a drive does, none by a fault of the tool",
        holds=driven == len(trials),
        seed=FIRST_SEED,
        details={"statuses": {seed: trial.status for seed, trial in trials.items()}, "hung": hung},
    )
