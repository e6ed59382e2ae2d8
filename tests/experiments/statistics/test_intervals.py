import math
from statistics import NormalDist

import numpy as np
import pytest

from tmpud.experiments.statistics.intervals import (
    Estimate,
    Z,
    discordant,
    mcnemar,
    mean_estimates,
    resampled_means,
    share_differences,
    tango,
    wilson,
)

REPEATS = 2000


def least_covered(repeats: int, level: float, miss: float = 1e-4) -> int:
    """Return how many of the repeated intervals of this coverage hold the truth at least, but for a chance of miss."""
    chances = np.random.default_rng(0).binomial(repeats, level, size=1_000_000)
    return int(np.quantile(chances, miss))


def test_the_interval_of_a_null_covers_nothing_as_often_as_it_says() -> None:
    rng = np.random.default_rng(1)
    covered = 0
    for _ in range(REPEATS):
        (found,) = mean_estimates(rng.normal(0, 20, size=(200, 1)), rng, resamples=500)
        covered += found.low <= 0 <= found.high
    # a bootstrap is normal where Student's t is due, and drawn: half a per cent is granted to either side
    assert least_covered(REPEATS, 0.945) <= covered <= REPEATS - least_covered(REPEATS, 1 - 0.955)


def test_the_interval_of_a_skewed_mean_covers_it_nearly_as_often() -> None:
    rng = np.random.default_rng(2)
    covered = 0
    for _ in range(REPEATS):
        (found,) = mean_estimates(rng.exponential(30, size=(200, 1)), rng, resamples=500)
        covered += found.low <= 30 <= found.high
    assert covered >= least_covered(REPEATS, 0.94)


def test_a_planted_difference_is_found_and_narrower_than_without_pairs() -> None:
    rng = np.random.default_rng(3)
    shared = rng.normal(500, 50, size=200)
    first, second = shared + rng.normal(0, 5, size=200), shared + 4 + rng.normal(0, 5, size=200)
    difference, alone = mean_estimates(np.column_stack([first - second, first]), rng)
    assert difference.low < -4 < difference.high < 0
    assert difference.high - difference.low < (alone.high - alone.low) / 3


def test_the_bootstraps_spread_is_the_standard_error() -> None:
    rng = np.random.default_rng(4)
    samples = rng.normal(0, 1, size=(400, 2))
    means = resampled_means(samples, rng)
    np.testing.assert_allclose(means.std(axis=0), samples.std(axis=0) / 20, rtol=0.05)
    np.testing.assert_allclose(means.mean(axis=0), samples.mean(axis=0), atol=0.003)


def test_counting_kinds_of_trials_is_the_same_as_drawing_trials() -> None:
    rng = np.random.default_rng(14)
    few = rng.choice([-1.0, 0.0, 1.0, 5.0], size=(400, 1), p=[0.1, 0.6, 0.2, 0.1])
    nearly = few + rng.uniform(-1e-6, 1e-6, size=few.shape)  # no two are equal: each trial is drawn
    by_kind, by_trial = (resampled_means(samples, rng) for samples in (few, nearly))
    quantiles = np.linspace(0.02, 0.98, 13)
    np.testing.assert_allclose(np.quantile(by_kind, quantiles), np.quantile(by_trial, quantiles), atol=0.02)
    assert np.std(by_kind) == pytest.approx(few.std() / 20, rel=0.05)


def test_what_is_paired_stays_paired_in_every_resample() -> None:
    samples = np.random.default_rng(5).normal(size=(50, 1))
    means = resampled_means(np.hstack([samples, 3 - 2 * samples]), np.random.default_rng(6))
    np.testing.assert_allclose(means[:, 1], 3 - 2 * means[:, 0])


def test_the_same_generator_gives_the_same_interval() -> None:
    samples = np.random.default_rng(7).exponential(size=(30, 1))
    assert mean_estimates(samples, np.random.default_rng(8)) == mean_estimates(samples, np.random.default_rng(8))


def test_the_accelerated_interval_leans_to_the_long_tail() -> None:
    samples = np.random.default_rng(9).exponential(size=(40, 1))
    (found,) = mean_estimates(samples, np.random.default_rng(10))
    assert found.high - found.value > 1.1 * (found.value - found.low)


def test_samples_that_are_all_equal_have_no_width() -> None:
    (found,) = mean_estimates(np.full((60, 1), 426.1), np.random.default_rng(0))
    assert (found.value, found.low, found.high) == pytest.approx((426.1, 426.1, 426.1))


def test_one_sample_bounds_nothing_and_none_has_no_mean() -> None:
    (one,) = mean_estimates(np.array([[5.0]]), np.random.default_rng(0))
    assert one == Estimate(5.0, -math.inf, math.inf, 1)
    (none,) = mean_estimates(np.empty((0, 1)), np.random.default_rng(0))
    assert (math.isnan(none.value), none.low, none.high, none.n) == (True, -math.inf, math.inf, 0)
    assert none.to_json() == {"value": None, "low": None, "high": None, "n": 0}


@pytest.mark.parametrize(("events", "n", "low", "high"), [(0, 10, 0, 0.2775), (81, 263, 0.2553, 0.3662)])
def test_wilsons_interval_is_the_published_one(events: int, n: int, low: float, high: float) -> None:
    found = wilson(events, n)
    assert (found.low, found.high) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize("n", [1, 30, 200, 4000])
def test_no_event_in_n_bounds_the_share_near_3_over_n(n: int) -> None:
    none, all_of_them = wilson(0, n), wilson(n, n)
    assert none.low == 0
    assert none.high == pytest.approx(Z**2 / (n + Z**2))
    assert (all_of_them.low, all_of_them.high) == pytest.approx((1 - none.high, 1))
    assert wilson(0, 0).high == 1


@pytest.mark.parametrize(("b", "c", "n"), [(12, 2, 50), (1, 0, 200), (0, 7, 40), (3, 3, 20), (8, 0, 9)])
def test_tangos_ends_are_where_the_most_likely_shares_are_just_not_rejected(b: int, c: int, n: int) -> None:
    for end, z in zip(tango(b, c, n), (Z, -Z), strict=True):
        # the likelihood's maximum over the share of "only second", found by trying all
        share = np.linspace(max(0.0, -end), (1 - end) / 2, 2_000_001)[1:-1]
        likelihood = b * np.log(share + end) + c * np.log(share) + (n - b - c) * np.log1p(-2 * share - end)
        best = share[np.argmax(likelihood)]
        deviation = np.sqrt(n * (2 * best + end - end**2))
        assert (b - c - n * end) / deviation == pytest.approx(z, abs=2e-3)


def test_pairs_that_never_differ_still_leave_room_for_a_rare_difference() -> None:
    never = np.zeros((200, 1), dtype=np.bool_)
    (found,) = share_differences(never, never, np.random.default_rng(0))
    assert (found.value, found.low, found.high) == pytest.approx((0, -(Z**2) / (200 + Z**2), Z**2 / (200 + Z**2)))


def test_the_interval_of_a_rare_paired_difference_covers_it() -> None:
    rng = np.random.default_rng(11)
    covered = 0
    for _ in range(REPEATS):
        luck = rng.uniform(size=(200, 1))
        (found,) = share_differences(luck < 0.02, (luck > 0.01) & (luck < 0.02), rng, resamples=500)
        covered += found.low <= 0.01 <= found.high
    assert covered >= least_covered(REPEATS, 0.95)


def test_a_planted_difference_of_shares_is_found_with_its_sign() -> None:
    rng = np.random.default_rng(12)
    luck = rng.uniform(size=(1000, 1))
    (found,) = share_differences(luck < 0.10, luck < 0.05, rng)
    assert 0.02 < found.low < 0.05 < found.high < 0.09


def test_discordant_pairs_are_told_apart_and_mcnemars_test_is_exact() -> None:
    first, second = np.array([1, 1, 1, 0, 0], dtype=np.bool_), np.array([0, 0, 1, 1, 0], dtype=np.bool_)
    assert discordant(first, second) == (2, 1)
    assert mcnemar(0, 5) == mcnemar(5, 0) == 2 / 32
    assert mcnemar(1, 9) == pytest.approx(2 * 11 / 1024)
    assert mcnemar(3, 3) == mcnemar(0, 0) == 1
    assert pytest.approx(NormalDist().inv_cdf(0.975)) == Z
