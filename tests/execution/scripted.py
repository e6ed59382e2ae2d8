"""A world that does what a script says, and short ways to run the loop in it."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field

import numpy as np

from tests.safety.fakes import FakeMotion
from tests.task.tiny_roads import driven, request, two_blocks
from tmpud.events import Event, Executed, Planned, Refused
from tmpud.execution.baselines import communication
from tmpud.execution.deliberation import Deliberation
from tmpud.execution.tmpud import run_tmpud
from tmpud.presets import TMPUD, Preset
from tmpud.roads.network import RoadNetwork
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Outcome
from tmpud.symbols import Action, Cost, ServiceRequest, State, TaskPlan, Transition
from tmpud.task.asp_planner import AspPlanner
from tmpud.task.domain import Domain
from tmpud.trajectory import Trajectory

HOME = State("a_0/0", 0)
AREA_1 = Transition(HOME, Action.MERGELEFT, State("a_1/1", 0))
AREA_2 = Transition(State("b_0/0", 0), Action.MERGELEFT, State("b_1/1", 0))
DRIVE_ON = Transition(HOME, Action.FORWARD, State("a_0/1", 0))
PLAN_A = "mergeleft forward forward turnleft"
PLAN_B = "forward forward mergeleft turnleft"
TO_GOAL = request("a_0/0", "goal_0/0")

SafeScript = Callable[[Transition, int], float]  # Safe of a transition when it is asked for the n-th time, from 0


def values(table: Mapping[Transition, float]) -> SafeScript:
    """Return a script that gives each transition one value, 1.0 where none is given."""
    return lambda step, _: table.get(step, 1.0)


def estimate(safe: float) -> SafetyEstimate:
    """Return an estimate of a value, with nothing in it that would explain it."""
    here = Trajectory(np.zeros(1), np.zeros((1, 3)), np.zeros(1))
    return SafetyEstimate(safe, None, safe, (), np.ones((0, 1)), np.ones(0), here, here.times)


@dataclass
class ScriptedWorld:
    """Drives any action in ``seconds``, or ends it as ``outcomes`` says."""

    length: Cost
    safe: SafeScript
    outcomes: Mapping[Transition, Outcome]
    seconds: float = 10.0
    time: float = 0.0
    distance: float = 0.0
    asked: list[Transition] = field(default_factory=list)
    driven: list[Transition] = field(default_factory=list)
    upcoming: list[TaskPlan] = field(default_factory=list)
    _known: dict[Transition, SafetyEstimate] = field(default_factory=dict)

    def path_length(self, step: Transition) -> float:
        return self.length[step]

    def estimate(self, step: Transition) -> SafetyEstimate:
        self.asked.append(step)
        self._known[step] = estimate(self.safe(step, self.asked.count(step) - 1))
        return self._known[step]

    def is_estimated(self, step: Transition) -> bool:
        return step in self._known

    def execute(self, step: Transition, upcoming: TaskPlan) -> Generator[Event, None, Outcome]:
        yield from ()
        self.driven.append(step)
        self.upcoming.append(upcoming)
        outcome = self.outcomes.get(step, Outcome.DONE)
        if outcome is not Outcome.INFEASIBLE:
            self.time += self.seconds
            self.distance += self.length[step]
            self._known.clear()
        return outcome


@dataclass(frozen=True)
class Paths(FakeMotion):
    """A motion planner that knows lengths."""

    cost: Cost = field(default_factory=dict)

    def path_length(self, transition: Transition) -> float:
        return self.cost[transition]


@dataclass
class Run:
    """A loop that ran in a scripted world."""

    world: ScriptedWorld
    mind: Deliberation
    outcome: Outcome | None = None
    events: list[Event] = field(default_factory=list)

    def of(self, kind: type[Event]) -> list[Event]:
        return [event for event in self.events if type(event) is kind]

    @property
    def plans(self) -> list[str]:
        return [actions(event.plan) for event in self.events if isinstance(event, Planned)]

    @property
    def refused(self) -> list[Transition]:
        return [event.step for event in self.events if isinstance(event, Refused)]

    @property
    def executed(self) -> list[Executed]:
        return [event for event in self.events if isinstance(event, Executed)]


def actions(plan: TaskPlan | list[Transition]) -> str:
    return " ".join(step.action for step in plan)


def run(
    safe: SafeScript | Mapping[Transition, float] | None = None,
    *,
    algorithm: str = "tmpud",
    beta: float = 0.3,
    preset: Preset = TMPUD,
    outcomes: Mapping[Transition, Outcome] | None = None,
    roads: RoadNetwork | None = None,
    goal: ServiceRequest = TO_GOAL,
    length: Cost | None = None,
    seconds: float = 10.0,
) -> Run:
    """Run the loop to its end; ``length`` is what the world measures from where the ego is."""
    roads = roads or two_blocks(100.0)
    cost, domain = driven(roads), Domain(roads, goal)
    script = safe if callable(safe) else values(safe or {})
    world = ScriptedWorld(length if length is not None else cost, script, outcomes or {}, seconds)
    mind = Deliberation(goal, domain, AspPlanner(roads, preset), Paths(cost=cost), world)
    told = Run(world, mind)
    loop = run_tmpud(domain.start_state(), mind, communication(algorithm, beta))
    while True:
        try:
            told.events.append(next(loop))
        except StopIteration as end:
            told.outcome = end.value
            return told
