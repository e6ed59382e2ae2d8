"""Every seam of the system on one page. Each part can be replaced by anything that has these methods."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

from tmpud.presets import Preset
from tmpud.symbols import Cost, Safe, ServiceRequest, State, TaskPlan, Transition

if TYPE_CHECKING:
    import numpy as np

    from tmpud.events import Event
    from tmpud.judging.rules import Verdict
    from tmpud.safety.estimator import SafetyEstimate
    from tmpud.scene import Control, FloatArray, Outcome, Scene, Vehicles
    from tmpud.task.asp_planner import PlanReport
    from tmpud.trajectory import Trajectory


class TaskPlanner(Protocol):
    """P^t: the best sequence of symbolic actions."""

    preset: Preset

    def solve(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> PlanReport:
        """Return the optimal plan with its terms; raises NoPlanError where there is none."""
        ...

    def alternatives(
        self, state: State, request: ServiceRequest, cost: Cost, safe: Safe, count: int
    ) -> tuple[PlanReport, ...]:
        """Return the next best plans, to explain the best one."""
        ...


class MotionPlanner(Protocol):
    """P^m: paths, trajectories and controls for one transition at a time."""

    def path_length(self, transition: Transition) -> float:
        """Return A*(x, x') between the canonical poses of s and s' [m]; inf where it cannot be driven."""
        ...

    def lanes(self, transition: Transition) -> tuple[str, ...]:
        """Return the lanes the transition drives on, in order, those through junctions included."""
        ...

    def trajectory(
        self, transition: Transition, scene: Scene, times: FloatArray, speed: float | None = None
    ) -> Trajectory:
        """Return the ego's planned motion along the transition from where it is in the scene.

        With a ``speed`` [m/s] it drives the same path at that constant speed, whatever the traffic does.
        """
        ...

    def control(self, scene: Scene) -> Control:
        """Return the command that follows the path of the transition being driven."""
        ...


class PathLengths(Protocol):
    """The part of a motion planner that the task level asks."""

    def path_length(self, transition: Transition) -> float:
        """Return A*(x, x') between the canonical poses of s and s' [m]; inf where it cannot be driven."""
        ...


class SafetyEstimator(Protocol):
    """Algorithm 1: how safe an action would be now."""

    def estimate(self, transition: Transition, scene: Scene, rng: np.random.Generator) -> SafetyEstimate:
        """Return Safe and what it was made of; only the generator that is passed in is drawn from."""
        ...


class Simulator(Protocol):
    """A town with traffic, in which the ego is moved by commands."""

    @property
    def versions(self) -> Mapping[str, str]:
        """Of which versions the programs are that make it, by their names."""
        ...

    def reset(self, lane: str, station: float) -> Scene:
        """Put the ego at a station of a lane, in the running town."""
        ...

    def step(self, control: Control) -> Scene:
        """Move the ego by one command for one step; the others react."""
        ...

    def announce(self, lanes: Sequence[str]) -> None:
        """Tell the others by which lanes, those through junctions included, the ego means to go on."""
        ...

    def everyone(self) -> Vehicles:
        """Return all other vehicles of the town."""
        ...

    def close(self) -> None:
        """Give back what the simulator holds."""
        ...


class Judge(Protocol):
    """Watches a drive, independent of who plans and simulates it."""

    def merge_began(self, scene: Scene, origin_lane: str, target_lane: str) -> None:
        """Take note that the ego begins to change lanes."""
        ...

    def observe(self, scene: Scene) -> tuple[Verdict, ...]:
        """Return what is to be said of this instant."""
        ...

    @property
    def metrics(self) -> Mapping[str, float]:
        """What the drive is measured by, so far."""
        ...


class World(Protocol):
    """What full and abstract simulation have in common for Algorithm 2."""

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        ...

    def path_length(self, step: Transition) -> float:
        """Return A*(x, x') from where the ego is now [m]; inf where it cannot be driven."""
        ...

    @property
    def distance(self) -> float:
        """How far the ego has driven [m]."""
        ...

    def estimate(self, step: Transition) -> SafetyEstimate:
        """Return the estimate for the present snapshot; asked twice, it is the same one."""
        ...

    def is_estimated(self, step: Transition) -> bool:
        """Whether there is an estimate of this action for the present snapshot."""
        ...

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:
        """Drive one action (Alg. 2, lines 9 to 14); ``upcoming`` is the rest of the plan."""
        ...
