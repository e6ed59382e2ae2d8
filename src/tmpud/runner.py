"""One mission from its words to its end: assembles map, planners, estimator, simulator and judge, and runs the loop."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Callable, Generator, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmpud.errors import InvalidStateError, NoPlanError, SimulatorError, SimulatorHangError
from tmpud.events import Event, Finished, Header
from tmpud.execution.baselines import communication
from tmpud.execution.deliberation import ALTERNATIVES, Deliberation
from tmpud.execution.timing import Stopwatch
from tmpud.execution.tmpud import Communicate, run_tmpud
from tmpud.execution.worlds import SimulatedWorld
from tmpud.judging.judge import Judge
from tmpud.motion.mapping import StateMapping
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.presets import Preset, preset_named
from tmpud.protocols import SafetyEstimator, Simulator
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import request as service_request
from tmpud.safety.estimator import SafeSetEstimator
from tmpud.scene import Outcome
from tmpud.symbols import ServiceRequest
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.domain import Domain

if TYPE_CHECKING:
    from tmpud.simulators.carla.session import Address

STATUS = {
    Outcome.DONE: "SUCCESS",
    Outcome.COLLIDE: "COLLISION",
    Outcome.BLOCKED: "STOPPED_BLOCKED",
    Outcome.TIME_LIMIT: "TIME_LIMIT",
    Outcome.INVALID: "INVALID_STATE",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Mission:
    """What to drive, how, and among whom."""

    map: str  # a shipped town's name or a .net.xml(.gz) file
    start: str  # lane or edge id, "x,y" in map coordinates, or "random"
    goal: str
    via: tuple[str, ...] = ()
    algorithm: str = "tmpud"  # tmpud, no-com or threshold
    beta: float = 0.3  # used by threshold
    traffic: int = 120  # vehicles
    seed: int = 7
    preset: str = "tmpud"

    def request(self, network: RoadNetwork) -> ServiceRequest:
        """Return the request on a map; RequestError where a place is not on it."""
        return service_request(network, self.start, (self.goal,), self.via, self.seed)


SimulatorFactory = Callable[[RoadNetwork, Mission], Simulator]
WorldFactory = Callable[..., SimulatedWorld]
EstimatorFactory = Callable[[Preset, LaneMotionPlanner, RoadNetwork], SafetyEstimator]


def sumo(network: RoadNetwork, mission: Mission) -> Simulator:
    """Return the default simulator: SUMO in this process."""
    from tmpud.simulators.sumo import SumoSimulator

    return SumoSimulator(network, traffic=mission.traffic, seed=mission.seed, request=mission.request(network))


def carla(server: Address) -> SimulatorFactory:
    """Return what starts a drive on a CARLA server, on its map of the network's name."""

    def start(network: RoadNetwork, mission: Mission) -> Simulator:
        from tmpud.simulators.carla.simulator import CarlaSimulator

        return CarlaSimulator(network, traffic=mission.traffic, seed=mission.seed, server=server)

    return start


def drive(
    mission: Mission,
    *,
    simulator: SimulatorFactory = sumo,
    stopwatch: Stopwatch | None = None,
    frames: bool = True,
    alternatives: int = ALTERNATIVES,
    communicate: Communicate | None = None,
    estimator: EstimatorFactory = SafeSetEstimator,
    world: WorldFactory = SimulatedWorld,
) -> Iterator[Event]:
    """Run one mission and yield its events, from Header to Finished.

    ``communicate`` takes the place of what the mission's algorithm does in lines 5 to 7 of Algorithm 2. The same
    mission gives the same events; ``frames`` and ``alternatives``, how many other plans are listed beside each one,
    are for people to look at; ``world`` stands in for SimulatedWorld. Raises MapError, RequestError or SimulatorError
    for what cannot be run.
    """
    preset = preset_named(mission.preset)
    communicate = communicate or communication(mission.algorithm, mission.beta)
    network = load_map(mission.map, preset.segment_length)
    request = mission.request(network)
    watch = stopwatch or Stopwatch()
    mapping = StateMapping(network, request, preset, mission.seed)
    motion = LaneMotionPlanner(network, mapping)
    planner = AspPlanner(network, preset)
    safety = estimator(preset, motion, network)
    planner.solve = watch.timed("plan", planner.solve)  # type: ignore[method-assign]
    safety.estimate = watch.timed("estimate", safety.estimate)  # type: ignore[method-assign]
    town, judge, rng = simulator(network, mission), Judge(network), np.random.default_rng(mission.seed)
    here = world(network, town, mapping, motion, safety, judge, rng, frames=frames)
    try:
        domain = Domain(network, request)
        start = domain.start_state()
        here.enter(*mapping(start))
        yield _header(mission, preset, network, request, town.versions)
        mind = Deliberation(request, domain, planner, motion, here, alternatives=alternatives)
        status, message = yield from _ended(run_tmpud(start, mind, communicate), here)
    finally:
        here.leave()
    travelled = here.time - here.began
    yield Finished(here.time, status, message, here.distance, travelled, mind.replans, here.metrics)


def _ended(run: Generator[Event, None, Outcome], world: SimulatedWorld) -> Generator[Event, None, tuple[str, str]]:
    """Pass a run's events on and return its status with a word of explanation."""
    try:
        outcome = yield from run
    except NoPlanError as error:
        return "NO_PLAN", str(error)
    except InvalidStateError as error:
        return "INVALID_STATE", str(error)
    except SimulatorHangError as error:
        return "SIM_HANG", str(error)
    except SimulatorError as error:
        return "SIM_CRASH", str(error)
    return STATUS[outcome], world.refused or ""


def _header(
    mission: Mission, preset: Preset, network: RoadNetwork, request: ServiceRequest, simulator: Mapping[str, str]
) -> Header:
    versions = {name: importlib.metadata.version(name) for name in ("tmpud", "clingo", "numpy")}
    return Header(
        time=0.0,
        versions={**versions, **simulator, "python": platform.python_version()},
        map={"name": network.name, "digest": network.digest, **asdict(network.frame)},
        mission={**asdict(mission), "request": _words(request), "settings": asdict(preset)},
    )


def _words(request: ServiceRequest) -> dict[str, Any]:
    return {"start": asdict(request.start), "goals": [asdict(goal) for goal in request.goals]}
