"""What is recalled is what would have been driven: in the worked case, and among the lights of the shipped town."""

import pickle
from functools import partial
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.execution.test_worked_case import SLOW, driven, executed
from tests.simulators.crowded import Neighbour, among
from tmpud.events import Estimated, Event, Executed
from tmpud.execution.memory import Memory, RecalledWorld, RecordedWorld, UnknownError
from tmpud.motion.planner import LaneMotionPlanner
from tmpud.protocols import Simulator
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.runner import Mission, drive
from tmpud.scene import Scene
from tmpud.simulators import sumo

PAPER = PAPER_MISSIONS["millbrook"]


def nobody(*_: Any) -> Simulator:
    """Stand where a simulator would: whatever it is asked for but its versions, it does not have."""
    return SimpleNamespace(versions={"libsumo": version("libsumo")})


def recorded(net: Path, algorithm: str, cars: tuple[Neighbour, ...]) -> tuple[list[Event], Memory]:
    memory: Memory = {}
    mission = Mission(map=str(net), start="a_0", goal="goal", traffic=0, algorithm=algorithm)
    world = partial(RecordedWorld, memory)
    return list(drive(mission, simulator=among(*cars), frames=False, world=world)), memory


def recalled(net: Path, algorithm: str, memory: Memory) -> list[Event]:
    mission = Mission(map=str(net), start="a_0", goal="goal", traffic=0, algorithm=algorithm)
    return list(drive(mission, simulator=nobody, frames=False, world=partial(RecalledWorld, memory)))


def test_noting_a_drive_changes_nothing(blocks_net: Path) -> None:
    events, memory = recorded(blocks_net, "tmpud", SLOW)
    assert tuple(events) == driven(blocks_net, "tmpud", SLOW)
    assert len(memory) == 1 + len(executed(tuple(events)))


@pytest.mark.parametrize(
    ("by", "cars", "algorithm"),
    [("no-com", (), "tmpud"), ("tmpud", (), "no-com"), ("threshold", SLOW, "tmpud"), ("no-com", SLOW, "no-com")],
)
def test_what_another_drove_needs_no_simulator(
    blocks_net: Path, by: str, cars: tuple[Neighbour, ...], algorithm: str
) -> None:
    _, memory = recorded(blocks_net, by, cars)
    carried_over = pickle.loads(pickle.dumps(memory))  # noqa: S301
    assert tuple(recalled(blocks_net, algorithm, carried_over)) == driven(blocks_net, algorithm, cars)


def test_what_nobody_drove_is_unknown(blocks_net: Path) -> None:
    _, memory = recorded(blocks_net, "tmpud", SLOW)
    for algorithm, known in (("no-com", memory), ("tmpud", {})):
        with pytest.raises(UnknownError):
            recalled(blocks_net, algorithm, known)


def test_an_estimate_on_the_way_is_the_same_among_lights(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sumo, "CYCLE", 0.0)
    shown: list[Any] = []
    observe = LaneMotionPlanner.trajectory

    def trajectory(self: LaneMotionPlanner, step: Any, scene: Scene, *rest: Any) -> Any:
        found = observe(self, step, scene, *rest)
        shown.append((scene.time, self.lights))
        return found

    monkeypatch.setattr(LaneMotionPlanner, "trajectory", trajectory)
    memory: Memory = {}
    mission = Mission(map="millbrook", start=PAPER.start, goal=PAPER.goal, traffic=0, seed=3)
    real = list(drive(mission, frames=False, world=partial(RecordedWorld, memory)))
    at_drive, shown[:] = list(shown), []
    assert list(drive(mission, simulator=nobody, frames=False, world=partial(RecalledWorld, memory))) == real
    assert shown == at_drive
    assert len({tuple(lights.items()) for _, lights in shown}) > 1
    assert sum(isinstance(event, Estimated) for event in real) == len(shown)
    assert sum(isinstance(event, Executed) for event in real) + 1 == len(memory)
