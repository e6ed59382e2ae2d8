import math
from dataclasses import replace

import numpy as np
import pytest

from tests.safety.fakes import car, scene
from tmpud.errors import RequestError
from tmpud.experiments.calibration.scores import BASELINES, LEAST, PRESETS, MergePanel
from tmpud.experiments.worlds.merges import LocalArea, local_network
from tmpud.presets import TMPUD, preset_named
from tmpud.roads.network import RoadNetwork
from tmpud.safety.gaps import merge_gaps
from tmpud.scene import Scene, VehicleState

AREA = LocalArea(TMPUD)  # a straight road of two lanes, 3.5 m apart


def around(*others: VehicleState) -> Scene:
    return scene(*others, ego=car(90.0, -1.75, speed=5.5, name="ego", lane="road0_0"))


def networks(segment_length: float) -> RoadNetwork:
    return local_network(replace(TMPUD, segment_length=segment_length))


def panel(*presets: str) -> MergePanel:
    return MergePanel(presets or PRESETS, AREA.motion, AREA.network, networks)


BESIDE = around(car(88.0, 1.75, speed=5.5, lane="road0_1"), car(110.0, 1.75, speed=4.0, lane="road0_1"))


def test_each_preset_says_what_it_says_alone_on_the_network_it_cuts_itself() -> None:
    asked = panel("tmpud", "released:share=exact")
    asked.estimate(AREA.transition(BESIDE), BESIDE, np.random.default_rng(0))
    for name in ("tmpud", "released:share=exact"):
        alone = LocalArea(preset_named(name)).safe(BESIDE, np.random.default_rng(0))
        assert asked.seen[0].scores[name] == alone


def test_the_baselines_and_the_least_share_stand_beside_the_presets() -> None:
    asked = panel()
    step = AREA.transition(BESIDE)
    first = asked.estimate(step, BESIDE, np.random.default_rng(0))
    scores = asked.seen[0].scores
    assert tuple(scores) == (*PRESETS, LEAST, *BASELINES)
    assert (scores["tmpud"], scores[LEAST]) == (first.safe, first.min_t)
    assert tuple(scores[name] for name in BASELINES) == tuple(merge_gaps(BESIDE, step, AREA.network))


def test_an_empty_road_is_safe_by_all_and_infinitely_so_by_the_baselines() -> None:
    asked, empty = panel(), around()
    asked.estimate(AREA.transition(empty), empty, np.random.default_rng(0))
    scores = asked.seen[0].scores
    assert all(scores[name] == 1.0 for name in (*PRESETS, LEAST))
    assert all(scores[name] is None for name in BASELINES)


def test_the_paper_s_aggregate_is_never_the_stricter_one() -> None:
    asked = panel()
    for x in np.linspace(70, 110, 21):
        there = around(car(float(x), 1.75, speed=5.0, lane="road0_1"))
        asked.estimate(AREA.transition(there), there, np.random.default_rng(0))
        scores = asked.seen[-1].scores
        strict, lenient = scores["tmpud"], scores["tmpud:aggregate=max+mean"]
        assert strict is not None
        assert lenient is not None
        assert strict <= lenient + 1e-12


def test_a_panel_needs_presets_that_there_are() -> None:
    with pytest.raises(RequestError, match="no preset"):
        MergePanel((), AREA.motion, AREA.network, networks)
    with pytest.raises(RequestError, match="no preset is called"):
        panel("paperr")
    assert math.isinf(preset_named("paper").segment_length)
