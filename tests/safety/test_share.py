import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.safety import agreement
from tmpud.safety.control_set import Controls, HalfPlane
from tmpud.safety.share import exact_share, sampled_share

STEERING = Controls((-6.0, 3.0), (-0.1, 0.1), steering=True)
YAWING = STEERING._replace(steering=False)


def share(limit: float, by_acceleration: float, by_turning: float, controls: Controls = STEERING) -> float:
    return float(exact_share(HalfPlane(np.array(limit), np.array(by_acceleration), np.array(by_turning)), controls))


def test_the_exact_share_agrees_with_quadrature() -> None:
    assert agreement.compare_exact_with_quadrature(4000, seed=1) < 1e-9


def test_the_exact_share_of_yaw_rates_is_the_area_of_the_cut_rectangle() -> None:
    assert agreement.compare_exact_with_polygon(2000, seed=2) < 1e-9


def test_sampling_agrees_with_the_exact_share() -> None:
    assert agreement.compare_sampled_with_exact(50, seed=3) < 0.002


@pytest.mark.parametrize("controls", [STEERING, YAWING])
def test_a_line_through_the_middle_leaves_half(controls: Controls) -> None:
    assert share(-1.5, 1.0, 0.0, controls) == pytest.approx(0.5)
    assert share(0.0, 0.0, 7.0, controls) == pytest.approx(0.5)
    assert share(-1.5, -1.0, 7.0, controls._replace(acceleration=(0.0, 3.0))) == pytest.approx(0.5)


@pytest.mark.parametrize("controls", [STEERING, YAWING])
def test_controls_without_effect_are_all_safe_or_all_unsafe(controls: Controls) -> None:
    assert share(0.0, 0.0, 0.0, controls) == 1.0
    assert share(1e-12, 0.0, 0.0, controls) == 1.0
    assert share(-1e-12, 0.0, 0.0, controls) == 0.0
    assert share(-np.inf, 0.0, 0.0, controls) == 0.0


@pytest.mark.parametrize("turning", [(-0.47, 0.47), (-0.6, 0.47), (-0.6, -0.47), (-0.47, 0.6), (0.1, 1.2)])
@pytest.mark.parametrize("steering", [True, False])
def test_all_and_nothing_are_exactly_one_and_zero(turning: tuple[float, float], steering: bool) -> None:
    for by_turning in (-7.0, 0.0, 7.0):
        assert share(-1e3, 1.0, by_turning, Controls((-6.0, 3.0), turning, steering)) == 0.0
        assert share(1e3, 1.0, by_turning, Controls((-6.0, 3.0), turning, steering)) == 1.0


def test_an_acceleration_range_of_one_value_is_judged_by_turning_alone() -> None:
    assert share(2.0, 1.0, 1.0, Controls((2.0, 2.0), (-0.1, 0.3), steering=False)) == pytest.approx(0.25)


@given(st.floats(-1e9, 1e9), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(1e-3, 1.5), st.booleans())
def test_a_share_lies_in_the_unit_interval_and_mirrors(
    limit: float, by_a: float, by_turning: float, widest: float, steering: bool
) -> None:
    controls = Controls((-6.0, 3.0), (-widest, widest), steering)
    left = share(limit, by_a, by_turning, controls)
    assert 0.0 <= left <= 1.0
    assert left == share(limit, by_a, -by_turning, controls)


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(-10, 10), st.floats(0, 10))
def test_a_looser_limit_never_lowers_the_share(limit: float, by_a: float, by_turning: float, more: float) -> None:
    assert share(limit + more, by_a, by_turning) >= share(limit, by_a, by_turning) - 1e-12


def test_samples_are_drawn_alike_whatever_fits_into_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    planes = agreement.as_planes(np.linspace(-6, 3, 40).reshape(4, 10), np.array(1.0), np.array(2.0))
    whole = sampled_share(planes, STEERING, 1000, np.random.default_rng(5))
    monkeypatch.setattr("tmpud.safety.share._CHUNK", 3000)
    assert np.array_equal(sampled_share(planes, STEERING, 1000, np.random.default_rng(5)), whole)
    assert whole.shape == (4, 10)
    assert np.all(np.diff(exact_share(planes, STEERING).ravel()) > 0)


def test_nothing_to_sample_is_an_empty_array() -> None:
    none = np.zeros((0, 17))
    assert sampled_share(HalfPlane(none, none, none), STEERING, 10, np.random.default_rng(0)).shape == (0, 17)
    assert exact_share(HalfPlane(none, none, none), STEERING).shape == (0, 17)
