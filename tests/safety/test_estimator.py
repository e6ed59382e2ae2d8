import math
from dataclasses import replace
from itertools import product
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.judging.roads import crossroads
from tests.safety.fakes import FORWARD, MERGELEFT, FakeMotion, car, mirrored, scene
from tmpud.errors import InfeasibleMotionError, InvalidStateError
from tmpud.geometry import Pose
from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
from tmpud.safety.estimator import SafeSetEstimator, SafetyEstimate, aggregate
from tmpud.scene import Scene, VehicleState
from tmpud.symbols import Transition

NETWORK = crossroads()
Aggregate = Literal["max+mean", "min+mean"]
VEHICLES = st.builds(
    lambda x, y, heading, speed, yaw_rate: VehicleState(
        f"{x},{y}", Pose(x, y, heading), "in_1", speed=speed, yaw_rate=yaw_rate
    ),
    st.floats(0, 40),
    st.floats(-15, 15),
    st.floats(-3, 3),
    st.floats(0, 8),
    st.floats(-0.5, 0.5),
)


def estimate(
    where: Scene, preset: Preset = TMPUD, motion: FakeMotion | None = None, step: Transition = MERGELEFT
) -> SafetyEstimate:
    estimator = SafeSetEstimator(preset, motion or FakeMotion(), NETWORK)
    return estimator.estimate(step, where, np.random.default_rng(0))


@pytest.mark.parametrize("preset", [TMPUD, PAPER, RELEASED])
def test_without_vehicles_an_action_is_safe(preset: Preset) -> None:
    for result in (estimate(scene(), preset), estimate(scene(car(20, 31)), preset)):
        assert (result.safe, result.worst, result.min_t, result.ids) == (1.0, None, 1.0, ())
        assert result.o.shape == (0, len(result.times))


@given(
    st.lists(VEHICLES, max_size=4),
    VEHICLES,
    st.sampled_from([TMPUD, replace(PAPER, samples=50), replace(RELEASED, share="exact")]),
)
def test_safe_lies_in_the_unit_interval_and_one_more_vehicle_never_raises_it(
    vehicles: list[VehicleState], more: VehicleState, preset: Preset
) -> None:
    before, after = (estimate(scene(*those), preset) for those in (vehicles, [*vehicles, more]))
    assert 0.0 <= after.safe <= before.safe <= 1.0
    assert after.min_t == after.o.min(initial=1.0)
    assert after.safe == min(after.o_star, default=1.0)


@given(st.lists(VEHICLES, max_size=4), st.floats(-0.05, 0.05))
def test_mirrored_scenes_have_mirrored_results(vehicles: list[VehicleState], curvature: float) -> None:
    left = estimate(scene(*vehicles), motion=FakeMotion(curvature))
    right = estimate(scene(*map(mirrored, vehicles)), motion=FakeMotion(-curvature))
    np.testing.assert_allclose(right.o, left.o, atol=1e-9)
    assert right.ids == left.ids


def test_a_closing_car_beside_the_path_is_unsafe_and_named() -> None:
    closing = car(28, 2, speed=0.0, name="standing")
    result = estimate(scene(car(20, 25), closing))
    assert result.worst == "standing"
    assert result.safe < 0.4
    assert result.min_t == 0.0
    assert result.o.shape == (2, 17)


def test_a_car_in_the_same_place_leaves_no_safe_control() -> None:
    result = estimate(scene(car(20, 0)))
    assert result.safe == 0.0
    assert np.all(result.o == 0.0)


def test_a_car_ahead_that_drives_away_is_no_danger() -> None:
    assert estimate(scene(car(30, 3.2, speed=8.0))).safe == 1.0


@pytest.mark.parametrize(("name", "expected"), [("max+mean", 0.875), ("min+mean", 0.375)])
def test_the_paper_aggregates_with_the_best_instant_and_the_released_code_with_the_worst(
    name: Aggregate, expected: float
) -> None:
    preset = replace(TMPUD, aggregate=name)
    assert aggregate(np.array([[1.0, 1.0, 0.0, 1.0]]), preset) == pytest.approx([expected])


def test_sampling_comes_close_to_the_exact_share() -> None:
    where = scene(car(28, 3.2, speed=2.0), car(12, 3.2, speed=7.0))
    exact = estimate(where)
    sampled = estimate(where, replace(TMPUD, share="sampled", samples=20_000))
    np.testing.assert_allclose(sampled.o, exact.o, atol=0.02)
    assert np.any((exact.o > 0.1) & (exact.o < 0.9))


def test_vehicles_on_another_level_or_out_of_range_are_not_looked_at() -> None:
    above = replace(car(20, 3), z=3.0)
    assert estimate(scene(above, car(20, 30.1), car(20, 29.9, name="near"))).ids == ("near",)


def test_no_horizon_lasts_until_the_goal_pose_at_the_first_speed() -> None:
    preset = replace(TMPUD, horizon=None, ego_speeds=(5.0, 4.0), interval=1.0)
    assert estimate(scene(), preset, FakeMotion(length=50.0)).times == pytest.approx(np.arange(11))
    assert len(estimate(scene(), replace(TMPUD, horizon=0.3, interval=0.1)).times) == 4
    with pytest.raises(InfeasibleMotionError, match="cannot be driven"):
        estimate(scene(), preset, FakeMotion(length=math.inf))


def test_of_several_constant_speeds_the_worst_counts() -> None:
    standing = scene(car(40, 0, speed=0.0))
    slow, fast = (estimate(standing, replace(TMPUD, ego_speeds=(v,))).safe for v in (2.0, 7.0))
    both = estimate(standing, replace(TMPUD, ego_speeds=(2.0, 7.0)))
    assert fast < slow
    assert both.safe == fast
    assert np.all(both.trajectory.speeds == 7.0)


def test_a_scene_that_is_not_finite_is_refused() -> None:
    for bad in (scene(car(math.nan, 0)), scene(ego=car(20, 0, speed=math.inf))):
        with pytest.raises(InvalidStateError, match="not finite"):
            estimate(bad)


@pytest.mark.parametrize("step", [MERGELEFT, FORWARD])
def test_a_scene_too_large_for_an_index_is_refused_and_never_called_safe(step: Transition) -> None:
    for speed in (1e50, 1e155, 1e300):
        with pytest.raises(InvalidStateError, match=r"scene at 0.0 s .* not below 1e\+50"):
            estimate(scene(car(26, 6, speed=speed)), step=step)


def test_the_largest_scenes_have_an_index() -> None:
    places, speeds, yaw_rates = (0.0, 20.0, 26.0), (8.0, 1e20, 0.9e50), (0.0, 1e-9, 0.1, -0.9e50)
    for x, heading, speed, yaw_rate in product(places, (0.0, 1.0, math.pi / 2), speeds, yaw_rates):
        assert 0.0 <= estimate(scene(replace(car(x, 3, heading, speed), yaw_rate=yaw_rate))).safe <= 1.0


def test_a_trajectory_that_is_not_finite_is_refused() -> None:
    with pytest.raises(InvalidStateError, match=r"trajectory of .* not finite"):
        estimate(scene(), motion=FakeMotion(curvature=math.nan))


def test_an_estimate_depends_on_its_inputs_only() -> None:
    where = scene(car(28, 3.2, speed=2.0), car(12, 3.2, speed=7.0))
    assert np.array_equal(estimate(where, PAPER).o, estimate(where, PAPER).o)
