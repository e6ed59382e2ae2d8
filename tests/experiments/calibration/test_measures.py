import math
import warnings
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmpud.experiments.calibration.measures import (
    Truth,
    area,
    brier,
    interval,
    isotonic,
    recalibrated,
    refusals,
    reliability,
    roc,
)
from tmpud.scene import FloatArray

SAFETY = np.array([0.9, 0.8, 0.3, 0.1])
UNSAFE = np.array([False, False, True, True])
MERGES = st.lists(st.tuples(st.sampled_from([0.0, 0.25, 0.5, 1.0, math.inf]), st.booleans()), min_size=2, max_size=30)


def arrays(merges: list[tuple[float, bool]]) -> tuple[FloatArray, Truth]:
    return np.array([score for score, _ in merges]), np.array([unsafe for _, unsafe in merges])


def random_merges(n: int, seed: int) -> tuple[FloatArray, Truth]:
    """Return scores that are right: a merge of score s is unsafe with probability 1 - s."""
    rng = np.random.default_rng(seed)
    safety = rng.random(n)
    return safety, rng.random(n) > safety


def test_a_score_that_separates_has_area_one_and_its_opposite_zero() -> None:
    assert area(SAFETY, UNSAFE) == 1.0
    assert area(-SAFETY, UNSAFE) == 0.0


def test_a_score_that_says_nothing_has_area_one_half() -> None:
    assert area(np.ones(4), UNSAFE) == 0.5
    rng = np.random.default_rng(3)
    assert area(rng.random(20_000), rng.random(20_000) < 0.3) == pytest.approx(0.5, abs=0.02)


def test_without_both_kinds_of_merges_there_is_no_area() -> None:
    assert math.isnan(area(SAFETY, np.zeros(4, dtype=np.bool_)))


@given(MERGES)
def test_the_area_is_the_chance_that_an_unsafe_merge_scores_lower_ties_counted_half(
    merges: list[tuple[float, bool]],
) -> None:
    safety, unsafe = arrays(merges)
    pairs = list(product(safety[unsafe], safety[~unsafe]))
    if pairs:
        assert area(safety, unsafe) == pytest.approx(np.mean([(a < b) + (a == b) / 2 for a, b in pairs]))


@given(MERGES)
def test_each_corner_of_the_curve_is_what_its_threshold_refuses(merges: list[tuple[float, bool]]) -> None:
    safety, unsafe = arrays(merges)
    if unsafe.all() or not unsafe.any():
        return
    curve = roc(safety, unsafe)
    assert (curve.hits[0], curve.false_alarms[0]) == (0.0, 0.0)
    for threshold, hits, false_alarms in zip(curve.threshold, curve.hits, curve.false_alarms, strict=True):
        assert hits == pytest.approx((safety[unsafe] <= threshold).mean())
        assert false_alarms == pytest.approx((safety[~unsafe] <= threshold).mean())


def test_the_brier_score_of_certainty_is_zero_or_one_and_of_a_coin_a_quarter() -> None:
    assert brier(UNSAFE.astype(float), UNSAFE) == 0.0
    assert brier(1.0 - UNSAFE, UNSAFE) == 1.0
    assert brier(np.full(4, 0.5), UNSAFE) == 0.25


def test_a_threshold_refuses_what_is_below_it_and_not_what_equals_it() -> None:
    none, some, all_ = refusals(SAFETY, UNSAFE, (0.1, 0.8, 0.95))
    assert (none.refused, none.unsafe) == (0.0, 0.5)
    assert (some.refused, some.unsafe) == (0.5, 0.0)
    assert all_.refused == 1.0
    assert math.isnan(all_.unsafe)


def test_a_true_probability_lies_on_the_diagonal_of_the_reliability_diagram() -> None:
    safety, unsafe = random_merges(50_000, seed=5)
    bins = reliability(1 - safety, unsafe)
    assert sum(found.n for found in bins) == 50_000
    assert [found.unsafe for found in bins] == pytest.approx([found.predicted for found in bins], abs=0.03)


def test_both_ends_of_the_scale_have_a_bin_and_empty_bins_are_left_out() -> None:
    first, last = reliability(np.array([0.0, 1.0, 1.0]), np.array([False, True, False]))
    assert (first.low, first.n, first.unsafe) == (0.0, 1, 0.0)
    assert (last.high, last.n, last.unsafe) == (1.0, 2, 0.5)


@given(MERGES)
def test_isotonic_probabilities_are_the_max_of_min_means_of_runs(merges: list[tuple[float, bool]]) -> None:
    safety, unsafe = arrays(merges)
    levels = np.unique(safety)
    for i, level in enumerate(levels):  # falling: the least over lower ends of the greatest over upper ends
        runs = [[unsafe[(safety >= low) & (safety <= high)].mean() for high in levels[i:]] for low in levels[: i + 1]]
        assert isotonic(safety, unsafe)(np.array([level]))[0] == pytest.approx(min(max(run) for run in runs))


def test_recalibration_turns_any_rising_scale_into_true_probabilities() -> None:
    safety, unsafe = random_merges(5000, seed=6)
    fitted = recalibrated(safety**5 * 100, unsafe, np.arange(5000), np.random.default_rng(0))
    assert np.abs(fitted - (1 - safety)).mean() < 0.05


def test_recalibration_never_looks_at_the_merge_s_own_group() -> None:
    safety, unsafe = np.arange(4.0), np.array([True, False, True, False])
    groups = np.array([0, 0, 1, 1])
    fitted = recalibrated(safety, unsafe, groups, np.random.default_rng(0))
    assert fitted.tolist() == [1.0, 1.0, 0.0, 0.0]
    with pytest.raises(ValueError, match="two groups"):
        recalibrated(safety, unsafe, np.zeros(4, dtype=np.intp), np.random.default_rng(0))


def test_the_interval_holds_the_true_area_nineteen_times_of_twenty() -> None:
    held = 0
    for seed in range(40):
        safety, unsafe = random_merges(150, seed)
        low, high = interval(area, safety, unsafe, np.arange(150), np.random.default_rng(seed), 400)
        held += low <= 5 / 6 <= high  # the area of a right score that is uniform
    assert 34 <= held <= 40


def test_merges_that_are_copies_of_each_other_do_not_narrow_the_interval() -> None:
    safety, unsafe = random_merges(60, seed=7)
    one = interval(area, safety, unsafe, np.arange(60), np.random.default_rng(0))
    copies = np.tile(np.arange(60), 10)
    assert interval(area, safety[copies], unsafe[copies], copies, np.random.default_rng(0)) == pytest.approx(one)


def test_without_unsafe_merges_there_is_no_interval() -> None:
    found = interval(area, SAFETY, np.zeros(4, dtype=np.bool_), np.arange(4), np.random.default_rng(0))
    assert all(map(math.isnan, found))


def test_area_brier_and_isotonic_fit_are_those_of_scikit_learn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        metrics = pytest.importorskip("sklearn.metrics", reason="needs the extra 'peers'")
        regression = pytest.importorskip("sklearn.isotonic").IsotonicRegression(increasing=False)
    safety, unsafe = random_merges(500, seed=8)
    safety = safety.round(2)
    assert area(safety, unsafe) == pytest.approx(metrics.roc_auc_score(unsafe, -safety))
    assert brier(1 - safety, unsafe) == pytest.approx(metrics.brier_score_loss(unsafe, 1 - safety))
    assert isotonic(safety, unsafe)(safety) == pytest.approx(regression.fit_transform(safety, unsafe))
