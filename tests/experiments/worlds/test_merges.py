from collections import Counter
from typing import Any

import numpy as np
import pytest

from tmpud.experiments.statistics.paper_numbers import FIGURE4
from tmpud.experiments.worlds.merges import CONDITIONS, LocalArea, LocalMerge, local_merges
from tmpud.judging.rules import Kind
from tmpud.presets import PRESETS
from tmpud.scene import Scene
from tmpud.simulators.local import Condition, LocalRoads, PlacementLaw
from tmpud.symbols import Action

DENSE = CONDITIONS["high density, high acceleration"]
STATION = PlacementLaw().ego_station


def record(merge: LocalMerge) -> tuple[Any, ...]:
    others = merge.scene.others
    return merge.outcome, merge.verdicts, merge.scene.ego, others.ids, others.x.tolist(), others.speed.tolist()


def safe(scene: Scene) -> dict[str, float]:
    return {name: LocalArea(preset).safe(scene, np.random.default_rng(1)) for name, preset in PRESETS.items()}


def test_there_are_the_conditions_of_the_paper() -> None:
    assert tuple(CONDITIONS) == tuple(FIGURE4)
    assert [(c.neighbours, c.acceleration) for c in CONDITIONS.values()] == [(1, 0.5), (1, 1.0), (3, 0.5), (3, 1.0)]


def test_a_merge_with_nobody_near_is_safe_and_succeeds() -> None:
    for merge in local_merges(Condition(neighbours=0, acceleration=1.0), 6, seed=1, roads=6):
        assert (merge.outcome, merge.verdicts) == ("merge", ())
        assert safe(merge.scene) == dict.fromkeys(PRESETS, 1.0)


def test_a_merge_into_a_car_right_beside_is_never_safe_nor_without_harm(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LocalRoads, "_places", lambda self, origin: [(1 - origin, STATION)])  # noqa: ARG005
    for merge in local_merges(Condition(neighbours=1, acceleration=0.5), 10, seed=1, roads=10):
        assert merge.outcome != "merge"
        assert {v.rule for v in merge.verdicts if v.kind is Kind.COLLISION} <= {"merge"}
        assert safe(merge.scene)["tmpud"] < 0.5


def test_cutting_in_right_before_a_car_harms_it_more_often_than_leaving_room(monkeypatch: pytest.MonkeyPatch) -> None:
    harmed = {}
    for behind in (6.0, 20.0):
        monkeypatch.setattr(LocalRoads, "_places", lambda self, origin: [(1 - origin, STATION - behind)])  # noqa: ARG005, B023
        merges = local_merges(Condition(neighbours=1, acceleration=0.5), 20, seed=1, roads=20)
        harmed[behind] = sum(merge.outcome != "merge" for merge in merges)
    assert harmed[6.0] >= 5
    assert harmed[20.0] == 0


def test_the_leader_of_the_own_lane_is_not_run_into(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LocalRoads, "_places", lambda self, origin: [(origin, STATION + 9.0)])  # noqa: ARG005
    for merge in local_merges(Condition(neighbours=1, acceleration=1.0), 20, seed=1, roads=20):
        assert merge.outcome == "merge"


def test_the_same_seed_gives_the_same_merges_and_another_gives_others() -> None:
    first, again, other = ([record(m) for m in local_merges(DENSE, 10, seed, roads=5)] for seed in (1, 1, 2))
    assert first == again
    assert first != other
    assert first[:5] != first[5:]


def test_a_longer_series_begins_with_a_shorter_one() -> None:
    short = [record(merge) for merge in local_merges(DENSE, 5, 1, roads=5)]
    assert [record(merge) for merge in local_merges(DENSE, 7, 1, roads=5)][:5] == short


def test_merges_lead_to_either_side_and_start_where_the_ego_is() -> None:
    area = LocalArea(PRESETS["tmpud"])
    actions = Counter[Action]()
    for merge in local_merges(DENSE, 12, 3, roads=12):
        step = area.transition(merge.scene)
        here, there = (area.network.segments[state.segment] for state in (step.state, step.next_state))
        assert here.lane == merge.scene.ego.lane != there.lane
        assert here.start <= merge.scene.ego.pose.x <= here.end
        actions[step.action] += 1
    assert set(actions) == {Action.MERGELEFT, Action.MERGERIGHT}
