"""Intervals of means, shares and paired differences: bootstrap (BCa), Wilson, Tango, McNemar. All at 95 %."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmpud.scene import FloatArray

BoolArray = NDArray[np.bool_]

LEVEL = 0.95
RESAMPLES = 10_000
FEW = 16  # trials per kind, on average, from which on kinds are counted instead of trials
CHUNK = 250  # resamples at once: bounds the memory at CHUNK times N
_NORMAL = NormalDist()
Z = _NORMAL.inv_cdf(0.5 + LEVEL / 2)


@dataclass(frozen=True, slots=True)
class Estimate:
    """A value with its 95 % interval; infinite ends where n is too small to bound it, NaN where nothing was seen."""

    value: float
    low: float
    high: float
    n: int  # trials behind it

    def scaled(self, factor: float) -> Estimate:
        """Return the estimate in another unit; the factor is positive."""
        return Estimate(self.value * factor, self.low * factor, self.high * factor, self.n)

    def to_json(self) -> dict[str, Any]:
        """Return the estimate with None for what is not finite."""
        ends = {name: getattr(self, name) for name in ("value", "low", "high")}
        return {**{name: end if math.isfinite(end) else None for name, end in ends.items()}, "n": self.n}


def resampled_means(samples: FloatArray, rng: np.random.Generator, resamples: int = RESAMPLES) -> FloatArray:
    """Return the (resamples, K) means of N trials drawn anew with replacement out of (N, K) samples.

    A resample draws whole trials, so that what was paired in a trial stays paired.
    """
    n = len(samples)
    kinds, frequency = np.unique(samples, axis=0, return_counts=True)
    if FEW * len(kinds) <= n:  # the same law, counted by kind: quick where most trials are alike
        return np.asarray(rng.multinomial(n, frequency / n, size=resamples) @ kinds / n)
    means = np.empty((resamples, samples.shape[1]))
    for start in range(0, resamples, CHUNK):
        rows = min(CHUNK, resamples - start)
        drawn = rng.integers(n, size=(rows, n)) + n * np.arange(rows)[:, None]
        times = np.bincount(drawn.ravel(), minlength=rows * n).reshape(rows, n)
        means[start : start + rows] = times @ samples / n
    return means


def mean_estimates(samples: FloatArray, rng: np.random.Generator, resamples: int = RESAMPLES) -> list[Estimate]:
    """Return the mean of each column of (N, K) samples with its BCa bootstrap interval.

    Samples that are all equal have an interval without width: no resampling shows what was never seen.
    """
    n, columns = samples.shape
    if n < 2:
        values = samples[0] if n else np.full(columns, np.nan)
        return [Estimate(float(value), -math.inf, math.inf, n) for value in values]
    means = resampled_means(samples, rng, resamples)
    return [
        Estimate(float(column.mean()), *_bca(column, mean), n) for column, mean in zip(samples.T, means.T, strict=True)
    ]


def _bca(samples: FloatArray, means: FloatArray) -> tuple[float, float]:
    """Return the bias-corrected and accelerated interval of a mean (Efron 1987, Eqn. 3.7) from its (R,) resamples."""
    value = samples.mean()
    deviations = samples - value
    spread = float((deviations**2).sum())
    if spread < 1e-18 * max(1.0, value**2) * len(samples):
        return float(value), float(value)
    same = np.isclose(means, value, rtol=1e-12, atol=1e-12)
    below = (np.sum((means < value) & ~same) + np.sum(same) / 2) / len(means)
    bias = _NORMAL.inv_cdf(float(np.clip(below, 1 / len(means), 1 - 1 / len(means))))
    acceleration = float((deviations**3).sum()) / (6 * spread**1.5)
    ends = [bias + z for z in (-Z, Z)]
    shares = [_NORMAL.cdf(bias + end / (1 - acceleration * end)) for end in ends]
    low, high = np.quantile(means, shares)
    return float(low), float(high)


def wilson(events: int, n: int) -> Estimate:
    """Return a share with Wilson's score interval; none in n bounds it at about 3.8/n."""
    if not n:
        return Estimate(math.nan, 0.0, 1.0, 0)
    share, z2 = events / n, Z**2
    middle = (share + z2 / (2 * n)) / (1 + z2 / n)
    half = Z / (1 + z2 / n) * math.sqrt(share * (1 - share) / n + z2 / (4 * n * n))
    return Estimate(
        share, max(0.0, middle - half) if events else 0.0, min(1.0, middle + half) if events < n else 1.0, n
    )


def share_differences(
    first: BoolArray, second: BoolArray, rng: np.random.Generator, resamples: int = RESAMPLES
) -> list[Estimate]:
    """Return the difference of the shares of each column of paired (N, K) events, first minus second.

    The interval is the bootstrap's, widened to hold Tango's: where hardly any pair differs the bootstrap has
    hardly any width, although n trials cannot exclude a rare difference.
    """
    differences = first.astype(float) - second.astype(float)
    widened = []
    for column, found in enumerate(mean_estimates(differences, rng, resamples)):
        low, high = tango(*discordant(first[:, column], second[:, column]), found.n)
        low, high = (min(low, found.low), max(high, found.high)) if found.n > 1 else (low, high)
        widened.append(Estimate(found.value, low, high, found.n))
    return widened


def discordant(first: BoolArray, second: BoolArray) -> tuple[int, int]:
    """Return in how many of N pairs only the first happened, and in how many only the second."""
    return int(np.sum(first & ~second)), int(np.sum(second & ~first))


def tango(only_first: int, only_second: int, n: int) -> tuple[float, float]:
    """Return Tango's score interval (1998) of the difference of two paired shares, first minus second."""
    if not n:
        return -1.0, 1.0

    def score(difference: float) -> float:
        b = (2 * n - only_first + only_second) * difference - only_first - only_second
        c = -only_second * difference * (1 - difference)
        share = (math.sqrt(max(b * b - 8 * n * c, 0.0)) - b) / (4 * n)  # of only the second, most likely given it
        variance = n * (2 * share + difference * (1 - difference))
        excess = only_first - only_second - n * difference
        return excess / math.sqrt(variance) if variance > 0 else math.copysign(math.inf, excess)

    value = (only_first - only_second) / n
    low = _root(lambda d: score(d) - Z, -1.0, value)
    high = _root(lambda d: score(d) + Z, value, 1.0)
    return low, high


def _root(falling: Callable[[float], float], low: float, high: float) -> float:
    """Return where a falling function passes zero, by bisection; an end where it does not."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if falling(middle) > 0 else (low, middle)
    return (low + high) / 2


def mcnemar(only_first: int, only_second: int) -> float:
    """Return the exact two-sided p-value of McNemar's test, from the pairs in which only one happened."""
    n = only_first + only_second
    tail = sum(math.comb(n, k) for k in range(min(only_first, only_second) + 1))
    return min(1.0, 2 * tail / (1 << n))
