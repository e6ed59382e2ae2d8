import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from tests.execution.scripted import estimate
from tests.judging.roads import crossroads
from tmpud.dynamics import step, within_limits
from tmpud.errors import InvalidStateError
from tmpud.events import Event, Frame, Judged
from tmpud.execution.worlds import Limits, SimulatedWorld
from tmpud.geometry import Pose
from tmpud.judging.judge import Judge
from tmpud.motion.mapping import StateMapping
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.presets import TMPUD
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Control, Outcome, Scene, Vehicles, VehicleState
from tmpud.symbols import Action, Place, ServiceRequest, State, Transition

DT = 0.05
ROADS = crossroads()
REQUEST = ServiceRequest(Place("in_0", ("in_0/0",)), (Place("out_1", ("out_1/1",)),))
FORWARD = Transition(State("in_0/0", 0), Action.FORWARD, State("in_0/1", 0))
MERGE = Transition(State("in_0/0", 0), Action.MERGELEFT, State("in_1/1", 0))
Change = Callable[[Scene], Scene]


def parked(x: float, y: float = 0.0, lane: str = "in_0") -> VehicleState:
    return VehicleState(f"at {x:g}", Pose(x, y, 0.0), lane)


@dataclass
class FakeSimulator:
    """Moves the ego by its dynamics among cars that stand."""

    others: Sequence[VehicleState] = ()
    change: Change = lambda scene: scene
    commands: list[Control] = field(default_factory=list)
    announced: list[Sequence[str]] = field(default_factory=list)
    versions: Mapping[str, str] = field(default_factory=dict)

    def reset(self, lane: str, station: float) -> Scene:
        ego = VehicleState("ego", ROADS.lanes[lane].centre.pose_at(station), lane, speed=5.0)
        self.scene = Scene(100.0, ego, Vehicles.of(list(self.others)), {"J": "GGGGG"})
        return self.scene

    def step(self, control: Control) -> Scene:
        self.commands.append(control)
        ego = step(self.scene.ego, control, DT)
        lane = ROADS.locate(ego.pose.x, ego.pose.y)[0].id
        self.scene = replace(self.scene, time=round(self.scene.time + DT, 3), ego=replace(ego, lane=lane))
        return self.change(self.scene)

    def announce(self, lanes: Sequence[str]) -> None:
        self.announced.append(lanes)

    def everyone(self) -> Vehicles:
        return self.scene.others

    def close(self) -> None:
        pass


@dataclass
class CountingEstimator:
    """Says of each estimate how many there were before it, and when it was made."""

    made: list[float] = field(default_factory=list)

    def estimate(self, transition: Transition, scene: Scene, rng: np.random.Generator) -> SafetyEstimate:  # noqa: ARG002
        self.made.append(scene.time)
        return estimate(1 / len(self.made))


class Motion(LaneMotionPlanner):
    """The motion planner, with a command of one's own in between."""

    injected: Callable[[int], Control | None] | None = None
    calls = 0

    def control(self, scene: Scene) -> Control:
        wished = super().control(scene)
        self.calls += 1
        return wished if self.injected is None else self.injected(self.calls)  # type: ignore[return-value]


def world(*others: VehicleState, limits: Limits | None = None, change: Change = lambda scene: scene) -> SimulatedWorld:
    mapping = StateMapping(ROADS, REQUEST, TMPUD)
    made = SimulatedWorld(
        ROADS,
        FakeSimulator(others, change),
        mapping,
        Motion(ROADS, mapping),
        CountingEstimator(),
        Judge(ROADS),
        np.random.default_rng(0),
        limits=limits,
    )
    made.enter("in_0", 25.0)
    return made


def simulator(of: SimulatedWorld) -> FakeSimulator:
    assert isinstance(of._simulator, FakeSimulator)
    return of._simulator


def execute(of: SimulatedWorld, transition: Transition) -> tuple[Outcome, list[Event]]:
    events: list[Event] = []
    driving = of.execute(transition, ())
    while True:
        try:
            events.append(next(driving))
        except StopIteration as end:
            return end.value, events


def test_an_action_is_driven_to_its_goal_pose() -> None:
    here = world()
    outcome, _ = execute(here, FORWARD)
    assert outcome is Outcome.DONE
    assert here.scene.ego.pose.x == pytest.approx(75.0, abs=0.5)
    assert here.distance == pytest.approx(50.0, abs=0.5)
    assert simulator(here).announced == [["in_0"]]


def test_a_merge_ends_on_the_other_lane() -> None:
    here = world()
    assert execute(here, MERGE)[0] is Outcome.DONE
    assert here.scene.ego.lane == "in_1"
    assert here.scene.ego.pose.y == pytest.approx(3.2, abs=0.3)


def test_an_estimate_is_of_the_present_snapshot_and_asked_twice_the_same() -> None:
    here = world()
    first = here.estimate(MERGE)
    assert here.estimate(MERGE) is first
    assert here.is_estimated(MERGE)
    assert not here.is_estimated(FORWARD)
    execute(here, FORWARD)
    assert not here.is_estimated(MERGE)
    assert here.estimate(MERGE) is not first
    assert isinstance(here._estimator, CountingEstimator)
    assert here._estimator.made == [100.0, here.time]


def test_behind_a_car_that_stands_for_ever_it_is_blocked_after_the_simulated_limit() -> None:
    here = world(parked(50.0), limits=Limits(standing=5.0))
    outcome, events = execute(here, FORWARD)
    assert outcome is Outcome.BLOCKED
    standing = [e for e in events if isinstance(e, Frame) and e.ego[3] < 10]
    assert here.time - standing[0].time == pytest.approx(5.0, abs=0.3)
    assert here.scene.ego.pose.x < 50.0 - 4.7


def test_a_drive_that_takes_too_long_in_simulated_time_is_given_up() -> None:
    here = world(limits=Limits(total=3.0))
    assert execute(here, FORWARD)[0] is Outcome.TIME_LIMIT
    assert here.time - here.began == pytest.approx(3.0, abs=2 * DT)


def test_time_spent_on_earlier_actions_counts() -> None:
    here = world(limits=Limits(total=11.0))
    assert execute(here, FORWARD)[0] is Outcome.DONE
    after = Transition(State("in_0/1", 0), Action.FORWARD, State("out_0/0", 0))
    assert execute(here, after)[0] is Outcome.TIME_LIMIT


def test_a_collision_ends_the_action_and_is_judged() -> None:
    outcome, events = execute(world(parked(30.2, 1.5)), FORWARD)
    assert outcome is Outcome.COLLIDE
    (judged,) = [event for event in events if isinstance(event, Judged)]
    assert (judged.kind, judged.vehicle) == ("collision", "at 30.2")


def test_what_no_path_does_is_infeasible_and_nothing_is_driven() -> None:
    here = world()
    here.enter("in_0", 70.0)
    assert execute(here, MERGE) == (Outcome.INFEASIBLE, [])
    assert simulator(here).commands == []
    assert here.path_length(MERGE) == math.inf


def test_the_path_is_measured_from_where_the_ego_is() -> None:
    here = world()
    assert here.path_length(FORWARD) == pytest.approx(50.0)
    here.enter("in_0", 35.0)
    assert here.path_length(FORWARD) == pytest.approx(40.0)
    here.enter("in_0", 25.3)
    assert here.path_length(FORWARD) == pytest.approx(50.0), "an overshoot decides nothing"


@pytest.mark.parametrize("bad", [None, Control(math.nan, 0.0), Control(math.inf, 0.0), Control(0.0, 1.0)])
def test_after_a_bad_command_it_brakes_to_a_standstill_and_the_state_is_invalid(bad: Control | None) -> None:
    here = world()
    assert isinstance(here._motion, Motion)
    here._motion.injected = lambda call: bad if call == 10 else Control(2.0 if call > 10 else 0.0, 0.0)
    assert execute(here, FORWARD)[0] is Outcome.INVALID
    assert all(within_limits(command) for command in simulator(here).commands)
    assert here.scene.ego.speed < 0.1


def test_a_bad_command_and_a_car_that_will_not_stop_end_at_the_time_limit() -> None:
    here = world(limits=Limits(total=5.0), change=lambda scene: replace(scene, ego=replace(scene.ego, speed=1.0)))
    assert isinstance(here._motion, Motion)
    here._motion.injected = lambda _: None
    assert execute(here, FORWARD)[0] is Outcome.INVALID


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize("name", ["x", "speed", "time"])
def test_an_ego_that_is_not_finite_is_an_invalid_state(name: str, value: float) -> None:
    def broken(scene: Scene) -> Scene:
        if name == "time":
            return replace(scene, time=value)
        ego = scene.ego
        return replace(scene, ego=replace(ego, speed=value) if name == "speed" else _moved(ego, value))

    with pytest.raises(InvalidStateError, match="not finite"):
        execute(world(change=broken), FORWARD)


def _moved(ego: VehicleState, x: float) -> VehicleState:
    return replace(ego, pose=ego.pose._replace(x=x))
