"""The world of a full simulation: Algorithm 1 on its scenes, and lines 9 to 14 of Algorithm 2 in its traffic."""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping
from dataclasses import dataclass

import numpy as np

from tmpud.errors import InfeasibleMotionError, InvalidStateError, SimulatorError
from tmpud.events import Event, Frame, Judged
from tmpud.execution.guard import Guard
from tmpud.motion.mapping import StateMapping
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.protocols import Judge, SafetyEstimator, Simulator
from tmpud.roads.network import RoadNetwork
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Outcome, Scene, Vehicles, VehicleState
from tmpud.symbols import TaskPlan, Transition

FRAME_INTERVAL = 0.1  # [s]
ANNOUNCED = 200.0  # [m] of the way ahead
AT_POSE = 0.5  # [m]
MOVING = 0.1  # [m/s] slower than this is standing


@dataclass(frozen=True, slots=True)
class Limits:
    """When a drive is given up, in simulated time."""

    standing: float = 180.0  # [s] without a move
    total: float = 1800.0  # [s]


class SimulatedWorld:
    """The ego in a simulator's traffic."""

    def __init__(
        self,
        network: RoadNetwork,
        simulator: Simulator,
        mapping: StateMapping,
        motion: LaneMotionPlanner,
        estimator: SafetyEstimator,
        judge: Judge,
        rng: np.random.Generator,
        *,
        frames: bool = True,
        limits: Limits | None = None,
    ) -> None:
        """``rng`` feeds estimates that sample; ``frames`` says whether ``execute`` yields what can be seen."""
        self._network, self._simulator, self._mapping, self._motion = network, simulator, mapping, motion
        self._estimator, self._judge, self._rng = estimator, judge, rng
        self._frames, self._limits = frames, limits or Limits()
        self._guard = Guard()
        self._estimates: dict[Transition, SafetyEstimate] = {}  # of the present snapshot
        self._standing = 0.0  # [s]
        self.distance = 0.0  # [m]

    def enter(self, lane: str, station: float) -> None:
        """Put the ego on the road; the drive begins. Raises SimulatorError where it appears within another car."""
        self.scene: Scene = self._simulator.reset(lane, station)
        self.began = self.scene.time
        if any(verdict.kind == "collision" for verdict in self._judge.observe(self.scene)):
            raise SimulatorError(f"there is no room for the ego on {lane} at {station:.1f} m")

    def leave(self) -> None:
        """End the simulation."""
        self._simulator.close()

    @property
    def time(self) -> float:
        return self.scene.time

    def path_length(self, step: Transition) -> float:
        """Return A*(x, x') from where the ego is [m]; inf where it cannot be driven.

        Within AT_POSE of f(s) that is the length from f(s), so that a step's overshoot decides between no two plans.
        """
        here, canonical = self._motion.where(self.scene, step), self._mapping(step.state)
        length = self._motion.path_length_from(here, step)
        at_pose = abs(here.station - canonical.station) < AT_POSE and math.isfinite(length)
        return self._motion.path_length_from(canonical, step) if at_pose else length

    @property
    def refused(self) -> str | None:
        """The first command that the independent brake refused, None while it has refused none."""
        return self._guard.refused

    @property
    def metrics(self) -> Mapping[str, float]:
        """What the judge has measured the drive by, so far."""
        return self._judge.metrics

    def estimate(self, step: Transition) -> SafetyEstimate:
        """Return Algorithm 1's estimate for the present snapshot; asked twice, it is the same one."""
        if step not in self._estimates:
            self._estimates[step] = self._estimator.estimate(step, self.scene, self._rng)
        return self._estimates[step]

    def is_estimated(self, step: Transition) -> bool:
        """Whether there is an estimate of this action for the present snapshot."""
        return step in self._estimates

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:
        """Drive one action (Alg. 2, lines 9 to 14)."""
        try:
            # Line 9
            self._motion.begin(step, self.scene, upcoming)
        except InfeasibleMotionError:
            return Outcome.INFEASIBLE
        self._announce(step, upcoming)
        # Line 10
        while not self._motion.reached():
            # Line 11
            command = self._guard.check(self._motion.control(self.scene))
            if self._motion.reached():
                break
            # Lines 12 and 13
            self._follow(self._simulator.step(command))
            yield from self._seen()
            verdicts = [Judged(v.time, v.kind, v.vehicle, v.rule, v.blame, v.detail) for v in self._verdicts]
            yield from verdicts
            if (outcome := self._ended(verdicts)) is not None:
                return outcome
        return Outcome.DONE

    def _announce(self, step: Transition, upcoming: TaskPlan) -> None:
        """Tell judge and simulator what the ego is about to do."""
        lanes, length = list(self._motion.lanes(step)), 0.0
        for following in upcoming:
            here = self._network.segments[following.state.segment]
            length += here.end - here.start
            if length < ANNOUNCED:
                lanes += self._motion.lanes(following)
        self._simulator.announce(lanes)
        origin, target = (self._network.segments[s.segment].lane for s in (step.state, step.next_state))
        if step.action.is_merge:
            self._judge.merge_began(self.scene, origin, target)

    def _follow(self, scene: Scene) -> None:
        """Take in the next scene; raises InvalidStateError where the ego in it is not finite."""
        if not all(map(math.isfinite, (*scene.ego.pose, scene.ego.speed, scene.time))):
            raise InvalidStateError(f"the simulator reports an ego that is not finite: {scene.ego}")
        before, now = self.scene.ego.pose, scene.ego.pose
        dt = scene.time - self.scene.time
        self.distance += math.hypot(now.x - before.x, now.y - before.y)
        self._standing = self._standing + dt if scene.ego.speed < MOVING else 0.0
        self.scene = scene
        self._estimates.clear()
        self._verdicts = self._judge.observe(scene)

    def _ended(self, verdicts: list[Judged]) -> Outcome | None:
        if any(verdict.kind == "collision" for verdict in verdicts):
            return Outcome.COLLIDE
        overtime = self.time - self.began > self._limits.total
        if self._guard.refused is not None:
            return Outcome.INVALID if overtime or self.scene.ego.speed < MOVING else None
        if self._standing > self._limits.standing:
            return Outcome.BLOCKED
        return Outcome.TIME_LIMIT if overtime else None

    def _seen(self) -> Generator[Event, None, None]:
        """Yield a frame at each whole FRAME_INTERVAL."""
        ticks = self.time / FRAME_INTERVAL
        if self._frames and abs(ticks - round(ticks)) < 1e-6:
            others = self._simulator.everyone()
            yield Frame(self.time, _row(self.scene.ego), others.ids, _rows(others), dict(self.scene.signals))


def _row(ego: VehicleState) -> tuple[int, int, int, int]:
    x, y, heading = ego.pose
    return round(x * 100), round(y * 100), round(heading * 1000), round(ego.speed * 100)


def _rows(others: Vehicles) -> tuple[tuple[int, int, int, int], ...]:
    table = np.stack([others.x * 100, others.y * 100, others.heading * 1000, others.speed * 100], axis=-1)
    return tuple((x, y, heading, speed) for x, y, heading, speed in np.rint(table).astype(int).tolist())
