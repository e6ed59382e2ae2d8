"""The full simulation's step, against what libsumo alone needs for the same step.

    python -m benchmarks full_step --vehicles 200 --steps 4000 --rounds 5

Each round drives one mission and notes what SUMO is told at every step. Then three processes take turns of CHUNK
steps: ``libsumo`` steps the warmed town without the ego, ``libsumo + ego`` tells SUMO the same again and reads one
context subscription, so that the same traffic meets the same ego, and ``stack`` drives the mission by
``runner.drive``. A round's time is the mean over its steps.
"""

from __future__ import annotations

import argparse
import contextlib
import multiprocessing
import time
from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection
from typing import Any, NamedTuple, TypeVar

from benchmarks.harness import Result, SkipError, progress
from tmpud.roads import RoadNetwork, load_map
from tmpud.runner import Mission, drive
from tmpud.scene import Control, Scene
from tmpud.simulators.conventions import EGO_ID
from tmpud.simulators.sumo import SumoSimulator

CHUNK = 250  # steps
FIRST_SEED = 500
SETTERS = ("setRoute", "moveToXY", "setSpeed")  # what a drive tells SUMO of vehicles

Town = TypeVar("Town", bound=SumoSimulator)
Told = tuple[str, tuple[Any, ...], dict[str, Any]]  # a function of libsumo.vehicle and its arguments


class Tape(NamedTuple):
    """What SUMO was told during a drive, step by step."""

    start: tuple[str, float]  # lane and station at which the ego appeared
    steps: list[list[Told]]


class EnoughError(Exception):
    """Ends a drive."""


class Watched(SumoSimulator):
    """SUMO that says when a step is about to begin."""

    before_step: Callable[[], None]
    start: tuple[str, float]

    def reset(self, lane: str, station: float) -> Scene:
        self.start = lane, station
        return super().reset(lane, station)

    def step(self, control: Control) -> Scene:
        self.before_step()
        return super().step(control)


def watched_drive(mission: Mission, before_step: Callable[[], None]) -> Watched:
    """Drive a mission to its end, or until ``before_step`` raises EnoughError."""
    towns: list[Watched] = []

    def town(network: RoadNetwork, mission: Mission) -> Watched:
        towns.append(_town(Watched, network, mission))
        towns[0].before_step = before_step
        return towns[0]

    with contextlib.suppress(EnoughError):
        for _ in drive(mission, simulator=town, frames=False, alternatives=0):
            pass
    return towns[0]


def _town(kind: type[Town], network: RoadNetwork, mission: Mission) -> Town:
    return kind(network, traffic=mission.traffic, seed=mission.seed, request=mission.request(network))


def tape(mission: Mission, steps: int) -> Tape:
    """Drive a mission for at most some steps, in whole chunks, and note what SUMO is told."""
    import libsumo

    told: list[list[Told]] = []

    def noting(name: str) -> Callable[..., Any]:
        function = getattr(libsumo.vehicle, name)

        def call(*args: Any, **kwargs: Any) -> Any:
            if told:
                told[-1].append((name, args, kwargs))
            return function(*args, **kwargs)

        return call

    def before_step() -> None:
        if len(told) == steps:
            raise EnoughError
        told.append([])

    for name in SETTERS:
        setattr(libsumo.vehicle, name, noting(name))
    start = watched_drive(mission, before_step).start
    return Tape(start, told[: len(told) // CHUNK * CHUNK])


class Turn:
    """One process's part in a round: called before each step, it waits for its turn at each whole chunk."""

    def __init__(self, parent: Connection, steps: int) -> None:
        self._parent, self._left = parent, steps
        self._began: float | None = None

    def __call__(self) -> None:
        """Raise EnoughError after the last step."""
        if self._left % CHUNK == 0:
            if self._began is not None:
                self._parent.send(time.process_time() - self._began)
            if self._left == 0:
                raise EnoughError
            self._parent.recv()
            self._began = time.process_time()
        self._left -= 1


def bare(mission: Mission, played: Tape, turn: Turn) -> None:
    """Step the town without the ego."""
    with _town(SumoSimulator, load_map(mission.map), mission):
        others_only = [[told for told in step if told[1][0] != EGO_ID] for step in played.steps]
        _replay(others_only, turn, read=False)


def with_ego(mission: Mission, played: Tape, turn: Turn) -> None:
    """Step the town with the ego as it was moved, and read its context subscription."""
    with _town(SumoSimulator, load_map(mission.map), mission) as town:
        town.reset(*played.start)
        _replay(played.steps, turn, read=True)


def _replay(steps: list[list[Told]], turn: Turn, *, read: bool) -> None:
    import libsumo

    for told in steps:
        turn()
        for name, args, kwargs in told:
            with contextlib.suppress(libsumo.TraCIException):  # as the drive does
                getattr(libsumo.vehicle, name)(*args, **kwargs)
        libsumo.simulationStep()
        if read:
            libsumo.vehicle.getContextSubscriptionResults(EGO_ID)
    turn()


def stack(mission: Mission, played: Tape, turn: Turn) -> None:  # noqa: ARG001
    """Drive the mission with all that the stack does."""
    watched_drive(mission, turn)


Peer = Callable[[Mission, Tape, Turn], None]
WITH_EGO = "libsumo + ego"
PEERS: dict[str, Peer] = {"libsumo": bare, WITH_EGO: with_ego, "stack (ours)": stack}


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--map", default="millbrook")
    parser.add_argument("--vehicles", type=int, default=200)
    parser.add_argument("--steps", type=_steps, default=2000, help=f"of a mission, at most; {CHUNK} or more")
    parser.add_argument("--rounds", type=int, default=3, help="missions, each with its own seed")


def measure(asked: argparse.Namespace) -> list[Result]:
    return [among(PEERS, WITH_EGO, asked)]


def _steps(text: str) -> int:
    if not text.isdecimal() or int(text) < CHUNK:
        raise argparse.ArgumentTypeError(
            f"{text} must be a whole number from {CHUNK} on, as peers take turns after {CHUNK}"
        )
    return int(text)


def among(peers: Mapping[str, Peer], base: str, asked: argparse.Namespace) -> Result:
    """Let some peers take turns on random missions."""
    rounds = []
    for seed in range(FIRST_SEED, FIRST_SEED + asked.rounds):
        progress(f"mission {seed}, {asked.vehicles} vehicles")
        mission = Mission(map=asked.map, start="random", goal="random", traffic=asked.vehicles, seed=seed)
        rounds.append(spent(mission, asked.steps, peers))
    times = {name: [row[name] for row, _ in rounds] for name in peers}
    facts = {**{name: vars(asked)[name] for name in ("map", "vehicles")}, "steps": [steps for _, steps in rounds]}
    title = f"a step of {asked.vehicles} vehicles on {asked.map}"
    return Result(title, base, times, clock="CPU time, missions' means", facts=facts, batch=(1, "steps"))


def spent(mission: Mission, steps: int, peers: Mapping[str, Peer]) -> tuple[dict[str, float], int]:
    """Return each peer's mean time for a step [s], and how many steps there were."""
    played: Tape = _in_child(_send_tape, mission, steps).recv()
    if not played.steps:
        raise SkipError(f"mission {mission.seed} ends within {CHUNK} steps")
    turns = {name: _in_child(_play, peer, mission, played) for name, peer in peers.items()}
    total = dict.fromkeys(peers, 0.0)
    for _ in range(len(played.steps) // CHUNK):
        for name, child in turns.items():
            child.send(None)
            total[name] += child.recv()
    return {name: seconds / len(played.steps) for name, seconds in total.items()}, len(played.steps)


def _send_tape(parent: Connection, mission: Mission, steps: int) -> None:
    parent.send(tape(mission, steps))


def _play(parent: Connection, peer: Peer, mission: Mission, played: Tape) -> None:
    with contextlib.suppress(EnoughError):
        peer(mission, played, Turn(parent, len(played.steps)))


def _in_child(work: Callable[..., None], *arguments: Any) -> Connection:
    """Start a process, which ends by itself, and return this end of a pipe to it; a process holds one simulation."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    context.Process(target=work, args=(there, *arguments), daemon=True).start()
    there.close()
    return here
