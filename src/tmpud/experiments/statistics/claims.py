"""The paper's claims, each a bound on a paired difference, and what our trials say about them.

Every claim reads "measure of the first algorithm minus measure of the second is below (or: at most) a bound".
Distances [m] are compared in the trials in which both arrived, unsafe trials (per 1,000) in those in which none met a
tool fault. (Those in which all five arrived leave out what No-com collides in, which is where the others turn away.)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Literal

import numpy as np

from tmpud.experiments.statistics.intervals import (
    RESAMPLES,
    Estimate,
    discordant,
    mcnemar,
    mean_estimates,
    share_differences,
)
from tmpud.experiments.statistics.pairing import Paired
from tmpud.experiments.statistics.paper_numbers import LABELS

FEWEST = 20  # trials: below this a bootstrap interval means little, and no verdict is given


class Verdict(StrEnum):
    """What an estimate and its 95 % interval say about a bound; from the best to the worst.

    HOLDS       the whole interval meets the bound
    CONSISTENT  the estimate meets it, the interval reaches beyond
    TOO_FEW     fewer than ``FEWEST`` trials to compare
    NOT_SEEN    the estimate does not meet it, the interval reaches or touches it
    REFUTED     the whole interval lies beyond the bound
    """

    HOLDS = "holds"
    CONSISTENT = "consistent"
    TOO_FEW = "too few trials"
    NOT_SEEN = "not seen"
    REFUTED = "refuted"


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """One comparison of two algorithms."""

    part: Literal["a", "b", "c"]
    text: str
    measure: Literal["distance", "unsafe"]  # [m], or unsafe trials per 1,000
    first: str
    second: str
    bound: float = 0.0  # of first minus second
    equal: bool = False  # whether meeting the bound exactly is enough


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """What the trials of one condition say about a claim."""

    condition: str
    claim: Claim
    difference: Estimate  # [m] or per 1,000
    verdict: Verdict
    p_value: float | None = None  # McNemar's, exact, two-sided, against no difference; a cross-check

    def to_json(self) -> dict[str, Any]:
        claim = {name: getattr(self.claim, name) for name in Claim.__slots__}
        difference = self.difference.to_json()
        return {"condition": self.condition, **claim, **difference, "verdict": self.verdict, "p_value": self.p_value}


PARTS = {
    "a": "No-com is the shortest and the least safe",
    "b": "over beta, the distance does not fall and unsafe behaviour does not rise",
    "c": "TMPUD is at most as unsafe as Th(0.3), about as safe as Th(0.5), and shorter than Th(0.5)",
}
MARGIN = 10.0  # unsafe trials per 1,000 that still count as "about as safe"


def _no_com() -> list[Claim]:
    claims = []
    for other in ("threshold(0.1)", "threshold(0.3)", "threshold(0.5)", "tmpud"):
        shorter, safer = f"No-com is shorter than {LABELS[other]}", f"{LABELS[other]} is safer than No-com"
        claims += [
            Claim(part="a", text=shorter, measure="distance", first="no-com", second=other),
            Claim(part="a", text=safer, measure="unsafe", first=other, second="no-com"),
        ]
    return claims


def _over_beta() -> list[Claim]:
    claims = []
    for low, high in ((0.1, 0.3), (0.3, 0.5)):
        less, more, where = f"threshold({low})", f"threshold({high})", f"from beta {low} to {high}"
        longer, safer = f"distance does not fall {where}", f"unsafe does not rise {where}"
        claims += [
            Claim(part="b", text=longer, measure="distance", first=less, second=more, equal=True),
            Claim(part="b", text=safer, measure="unsafe", first=more, second=less, equal=True),
        ]
    return claims


def _tmpud() -> list[Claim]:
    th3, th5 = "threshold(0.3)", "threshold(0.5)"
    as_safe = "TMPUD is at most as unsafe as Th(0.3)"
    nearly = f"TMPUD is at most {MARGIN:g} per 1,000 less safe than Th(0.5)"
    shorter = "TMPUD is shorter than Th(0.5)"
    return [
        Claim(part="c", text=as_safe, measure="unsafe", first="tmpud", second=th3, equal=True),
        Claim(part="c", text=nearly, measure="unsafe", first="tmpud", second=th5, bound=MARGIN, equal=True),
        Claim(part="c", text=shorter, measure="distance", first="tmpud", second=th5),
    ]


CLAIMS = (*_no_com(), *_over_beta(), *_tmpud())


def judge(paired: Paired, rng: np.random.Generator, resamples: int = RESAMPLES) -> tuple[Finding, ...]:
    """Return what one condition's trials say about the claims whose two algorithms were run, in the claims' order."""
    asked = [claim for claim in CLAIMS if {claim.first, claim.second} <= set(paired.algorithms)]
    by_distance = [claim for claim in asked if claim.measure == "distance"]
    by_safety = [claim for claim in asked if claim.measure == "unsafe"]
    found = dict(zip(by_distance, _distances(paired, by_distance, rng, resamples), strict=True))
    found |= dict(zip(by_safety, _unsafe(paired, by_safety, rng, resamples), strict=True))
    return tuple(
        Finding(
            condition=paired.condition,
            claim=claim,
            difference=found[claim],
            verdict=verdict(claim, found[claim]),
            p_value=_p_value(paired, claim) if claim.measure == "unsafe" else None,
        )
        for claim in asked
    )


def verdict(claim: Claim, difference: Estimate) -> Verdict:
    """Return what the difference says; see ``Verdict``. Equality meets the bound only of a claim that says so."""

    def meets(value: float) -> bool:
        return value <= claim.bound if claim.equal else value < claim.bound

    if difference.n < FEWEST:
        return Verdict.TOO_FEW
    if meets(difference.value):
        return Verdict.HOLDS if meets(difference.high) else Verdict.CONSISTENT
    return Verdict.NOT_SEEN if difference.low <= claim.bound else Verdict.REFUTED


def worst(findings: Iterable[Finding]) -> Verdict:
    """Return the verdict on a claim of several parts: that of its weakest part."""
    order = list(Verdict)
    return max((finding.verdict for finding in findings), key=order.index, default=Verdict.TOO_FEW)


def _columns(paired: Paired, claims: Sequence[Claim]) -> tuple[list[int], list[int]]:
    return [paired.column(claim.first) for claim in claims], [paired.column(claim.second) for claim in claims]


def _distances(paired: Paired, claims: Sequence[Claim], rng: np.random.Generator, resamples: int) -> list[Estimate]:
    found = []
    for claim in claims:
        columns = [paired.column(claim.first), paired.column(claim.second)]
        both = paired.distance[paired.arrived[:, columns].all(axis=1)][:, columns]
        found += mean_estimates(both[:, :1] - both[:, 1:], rng, resamples)
    return found


def _unsafe(paired: Paired, claims: Sequence[Claim], rng: np.random.Generator, resamples: int) -> list[Estimate]:
    first, second = _columns(paired, claims)
    unsafe = paired.unsafe[paired.clean]
    shares = share_differences(unsafe[:, first], unsafe[:, second], rng, resamples)
    return [share.scaled(1000) for share in shares]


def _p_value(paired: Paired, claim: Claim) -> float:
    unsafe = paired.unsafe[paired.clean]
    return mcnemar(*discordant(unsafe[:, paired.column(claim.first)], unsafe[:, paired.column(claim.second)]))
