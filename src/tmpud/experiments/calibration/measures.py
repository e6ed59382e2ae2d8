"""How well a score foretells an unsafe merge: ROC curve and area, Brier score, reliability, what a threshold does.

A score is a safety: the higher, the safer the merge was thought to be. The area under the ROC curve is the
probability that an unsafe merge has a lower score than a safe one, ties counted half (Mann and Whitney).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmpud.scene import FloatArray

Truth = NDArray[np.bool_]  # (n,) whether the merge was unsafe
RESAMPLES = 1000
FOLDS = 10
BINS = 10


@dataclass(frozen=True, slots=True, eq=False)
class Roc:
    """Refusing all merges with a score of at most ``threshold``; each field of shape (K,), from none to all."""

    threshold: FloatArray
    false_alarms: FloatArray  # share of the safe merges that are refused
    hits: FloatArray  # share of the unsafe merges that are refused


class Bin(NamedTuple):
    """The merges to which about the same probability of being unsafe was given."""

    low: float
    high: float
    n: int
    predicted: float  # mean over the bin
    unsafe: float  # share


class Refusal(NamedTuple):
    """What Threshold(beta) does: it refuses what has Safe < beta."""

    beta: float
    refused: float  # share of all merges
    unsafe: float  # share of those accepted; nan where none is


def roc(safety: FloatArray, unsafe: Truth) -> Roc:
    """Return the curve's corners; merges of equal score are refused together, so a tie is a slanted line."""
    levels, index = np.unique(safety, return_inverse=True)
    false_alarms, hits = (_rising(np.bincount(index, weights=kind)) for kind in (~unsafe, unsafe))
    return Roc(np.r_[-np.inf, levels], false_alarms, hits)


def area(safety: FloatArray, unsafe: Truth) -> float:
    """Return the area under the ROC curve; nan where all merges were safe or all unsafe."""
    curve = roc(safety, unsafe)
    return float(np.trapezoid(curve.hits, curve.false_alarms))


def brier(probability: FloatArray, unsafe: Truth) -> float:
    """Return the mean squared error of a probability of being unsafe; 0 is perfect."""
    return float(np.mean((probability - unsafe) ** 2))


def interval(
    measure: Callable[[FloatArray, Truth], float],
    scores: FloatArray,
    unsafe: Truth,
    groups: NDArray[np.intp],
    rng: np.random.Generator,
    resamples: int = RESAMPLES,
) -> tuple[float, float]:
    """Return a measure's 95 % bootstrap interval; whole groups (n,), numbered from 0, are drawn with replacement.

    Merges of one drive are alike, so drives are drawn and not merges. Draws in which the measure is nan don't count;
    nan where all are.
    """
    order = np.argsort(groups, kind="stable")
    members = np.split(order, np.cumsum(np.bincount(groups))[:-1])
    found = []
    for _ in range(resamples):
        drawn = np.concatenate([members[i] for i in rng.integers(len(members), size=len(members))])
        found.append(measure(scores[drawn], unsafe[drawn]))
    finite = [value for value in found if not math.isnan(value)]
    low, high = np.quantile(finite, [0.025, 0.975]) if finite else (math.nan, math.nan)
    return float(low), float(high)


def refusals(safety: FloatArray, unsafe: Truth, betas: Sequence[float]) -> tuple[Refusal, ...]:
    """Return what each threshold refuses, and how unsafe is what it lets through."""
    found = []
    for beta in betas:
        accepted = safety >= beta
        risk = float(unsafe[accepted].mean()) if accepted.any() else math.nan
        found.append(Refusal(beta, float(1 - accepted.mean()), risk))
    return tuple(found)


def reliability(probability: FloatArray, unsafe: Truth) -> tuple[Bin, ...]:
    """Return the bins of equal width that hold a merge; the last one holds its upper end too."""
    edges = np.linspace(0.0, 1.0, BINS + 1)
    index = np.clip(np.searchsorted(edges, probability, side="right") - 1, 0, BINS - 1)
    return tuple(
        Bin(
            float(edges[i]),
            float(edges[i + 1]),
            int((index == i).sum()),
            float(probability[index == i].mean()),
            float(unsafe[index == i].mean()),
        )
        for i in range(BINS)
        if (index == i).any()
    )


class Isotonic(NamedTuple):
    """A probability of being unsafe that never rises with the score: constant from each level up to the next."""

    levels: FloatArray  # (K,) scores, rising
    probabilities: FloatArray  # (K,) falling

    def __call__(self, safety: FloatArray) -> FloatArray:
        """Return the probabilities of scores; below the lowest level it is that level's."""
        return np.asarray(self.probabilities[np.maximum(np.searchsorted(self.levels, safety, side="right") - 1, 0)])


def isotonic(safety: FloatArray, unsafe: Truth) -> Isotonic:
    """Return the probabilities with the least squared error, by pooling adjacent violators."""
    levels, index = np.unique(safety, return_inverse=True)
    blocks: list[tuple[float, float, int]] = []  # unsafe merges, merges, levels
    for hits, n in zip(np.bincount(index, weights=unsafe), np.bincount(index), strict=True):
        block = (float(hits), float(n), 1)
        while blocks and blocks[-1][0] * block[1] <= block[0] * blocks[-1][1]:
            block = (blocks[-1][0] + block[0], blocks[-1][1] + block[1], blocks[-1][2] + block[2])
            blocks.pop()
        blocks.append(block)
    return Isotonic(levels, np.repeat([hits / n for hits, n, _ in blocks], [count for _, _, count in blocks]))


def recalibrated(safety: FloatArray, unsafe: Truth, groups: NDArray[np.intp], rng: np.random.Generator) -> FloatArray:
    """Return each merge's probability of being unsafe (n,), fitted to the merges of other groups only.

    Raises ValueError where there is only one group.
    """
    count = int(groups.max()) + 1
    if count < 2:
        raise ValueError("cross-validation needs two groups of merges")
    fold = (rng.permutation(count) % min(FOLDS, count))[groups]
    probability = np.empty(len(safety))
    for held in np.unique(fold):
        out = fold == held
        probability[out] = isotonic(safety[~out], unsafe[~out])(safety[out])
    return probability


def _rising(counts: NDArray[Any]) -> FloatArray:
    """Return the running share (K + 1,) from 0 to 1; nan where there is nothing to share."""
    total = counts.sum()
    return np.asarray(np.r_[0.0, np.cumsum(counts)] / (total if total else math.nan))
