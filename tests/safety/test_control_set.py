import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.safety.fakes import MERGELEFT, FakeMotion, car, scene
from tmpud.presets import RELEASED, TMPUD, Preset
from tmpud.safety.control_set import HalfPlane, SafetyIndex, controls, half_plane, in_use, safety_index
from tmpud.safety.share import exact_share
from tmpud.scene import Scene, Vehicles, VehicleState
from tmpud.trajectory import Trajectory, predict

RELEASED_EXACT = replace(RELEASED, share="exact")


def index_of(where: Scene, preset: Preset = TMPUD, times: tuple[float, ...] = (0.0,)) -> tuple[SafetyIndex, Trajectory]:
    ego = FakeMotion().trajectory(MERGELEFT, where, times)
    return safety_index(ego, where.others, predict(where.others, ego.times), preset), ego


@given(
    st.floats(2, 12), st.floats(2, 12), st.floats(-3, 3), st.floats(0, 8), st.floats(-0.5, 0.5),
    st.floats(0.5, 8), st.floats(-3, 3), st.floats(-0.5, 0.5), st.floats(0.5, 2),
)  # fmt: skip
def test_the_affine_rate_is_the_time_derivative_of_phi(
    x: float, y: float, heading: float, speed: float, yaw: float, v: float, a: float, w: float, alpha: float
) -> None:
    preset = replace(TMPUD, closing_weight=alpha)
    other = replace(car(x, y, heading, speed), yaw_rate=yaw)

    def phi(t: float) -> float:
        turned = w * t
        ego = Trajectory(
            np.array([0.0]),
            np.array([[v * t + a * t * t / 2, v * w * t * t / 2, turned]]),  # to second order in t
            np.array([v + a * t]),
        )
        moved = predict(Vehicles.of([other]), np.array([t]))
        return float(safety_index(ego, Vehicles.of([other]), moved, preset).phi[0, 0])

    index, _ = index_of(scene(other, ego=car(0, 0, speed=v)), preset)
    numeric = (phi(1e-5) - phi(-1e-5)) / 2e-5
    assert float(index.rate(np.array([a]), np.array([w]))[0, 0]) == pytest.approx(numeric, abs=1e-4, rel=1e-6)


def test_the_coefficients_push_towards_the_other_vehicle() -> None:
    ahead, _ = index_of(scene(car(26, 0)))
    assert ahead.by_acceleration[0, 0] == pytest.approx(1.0)
    assert ahead.by_yaw_rate[0, 0] == 0.0
    left, _ = index_of(scene(car(20, 6)))
    assert left.by_acceleration[0, 0] == pytest.approx(0.0)
    assert left.by_yaw_rate[0, 0] == pytest.approx(5.0)
    assert left.phi[0, 0] == pytest.approx(64 - 36)


def test_steering_turns_by_the_speed_over_the_wheelbase() -> None:
    index, ego = index_of(scene(car(20, 6)))
    assert half_plane(index, ego, TMPUD, 2.8).by_turning[0, 0] == pytest.approx(5.0 * 5.0 / 2.8)
    assert half_plane(index, ego, replace(TMPUD, turning="yaw rate"), 2.8).by_turning[0, 0] == pytest.approx(5.0)


def test_a_standing_ego_cannot_turn_away() -> None:
    index, ego = index_of(scene(car(26, 2), ego=car(20, 0, speed=0.0)))
    assert half_plane(index, ego, TMPUD, 2.8).by_turning[0, 0] == 0.0


@pytest.mark.parametrize("preset", [TMPUD, RELEASED_EXACT, replace(TMPUD, safety_distance=0.5)])
def test_a_vehicle_in_the_same_place_leaves_no_control(preset: Preset) -> None:
    index, ego = index_of(scene(car(20 + 9e-7, 0, speed=30.0)), preset)  # where they part quickly, too
    plane = half_plane(index, ego, preset, 2.8)
    assert index.drift[0, 0] == math.inf
    assert in_use(index, ego, preset)[0, 0]
    assert exact_share(plane, controls(preset))[0, 0] == 0.0


def test_the_margin_narrows_the_set() -> None:
    where = scene(car(26, 1, speed=4.8))
    index, ego = index_of(where)
    shares = [
        exact_share(half_plane(index, ego, replace(TMPUD, margin=eta), 2.8), controls(TMPUD)) for eta in (0.0, 3.0)
    ]
    assert shares[1][0, 0] < shares[0][0, 0]


def gated(phi: float, rate: float, preset: Preset) -> bool:
    one = np.ones((1, 1))
    index = SafetyIndex(phi * one, rate * one, 0 * one, 0 * one)
    _, ego = index_of(scene(car(26, 1)))
    return bool(in_use(index, ego, preset)[0, 0])


def test_the_gate_of_the_paper_opens_where_phi_reaches_zero() -> None:
    assert [gated(phi, -100.0, TMPUD) for phi in (-0.1, 0.0, 0.1)] == [False, True, True]


def test_the_gate_of_the_released_code_opens_where_phi_is_positive_and_hardly_falls() -> None:
    assert [gated(phi, 0.0, RELEASED) for phi in (-0.1, 0.0, 0.1)] == [False, False, True]
    assert [gated(1.0, rate, RELEASED) for rate in (-0.6, -0.5, -0.4)] == [False, False, True]


def braking(others: tuple[VehicleState, ...], deceleration: float) -> tuple[SafetyIndex, Trajectory]:
    where = scene(*others)
    _, ego = index_of(where, RELEASED, (0.0, 0.5))
    slowing = Trajectory(ego.times, ego.poses, np.array([5.0, 5.0 - deceleration / 2]))
    return safety_index(slowing, where.others, predict(where.others, ego.times), RELEASED), slowing


def test_the_gate_looks_at_the_control_that_the_trajectory_applies() -> None:
    behind = (car(38, 0, speed=3.0),)
    coasting, hard = braking(behind, 0.0), braking(behind, 200.0)
    assert in_use(*coasting, RELEASED)[0, 0]
    assert not in_use(*hard, RELEASED)[0, 0]


def test_half_planes_are_picked_by_a_mask() -> None:
    plane = HalfPlane(*(np.arange(6.0).reshape(2, 3) + k for k in range(3)))
    picked = plane.at(np.array([[True, False, False], [False, False, True]]))
    assert [list(values) for values in picked] == [[0, 5], [1, 6], [2, 7]]
