import json
import math

import numpy as np
import pytest

from tests.experiments.planted import AS_PAPER, planted, row
from tmpud.experiments.statistics.claims import CLAIMS, Claim, Finding, Verdict, judge, verdict, worst
from tmpud.experiments.statistics.intervals import Estimate
from tmpud.experiments.statistics.pairing import pair
from tmpud.experiments.statistics.rows import TrialRow

STRICT = Claim(part="c", text="", measure="distance", first="x", second="y")
WEAK = Claim(part="c", text="", measure="unsafe", first="x", second="y", equal=True)
MARGIN = Claim(part="c", text="", measure="unsafe", first="x", second="y", bound=10, equal=True)


def findings(rows: list[TrialRow]) -> tuple[Finding, ...]:
    (paired,) = pair(rows)
    return judge(paired, np.random.default_rng(0), resamples=2000)


@pytest.mark.parametrize(
    ("claim", "low", "value", "high", "expected"),
    [
        (STRICT, -3, -2, -1, Verdict.HOLDS),
        (STRICT, -3, -1, 0, Verdict.CONSISTENT),
        (STRICT, -3, -1, 1, Verdict.CONSISTENT),
        (STRICT, 0, 0, 0, Verdict.NOT_SEEN),
        (STRICT, -1, 0, 1, Verdict.NOT_SEEN),
        (STRICT, -1, 1, 3, Verdict.NOT_SEEN),
        (STRICT, 0.1, 1, 3, Verdict.REFUTED),
        (WEAK, -3, -1, 0, Verdict.HOLDS),
        (WEAK, 0, 0, 0, Verdict.HOLDS),
        (WEAK, -1, 0, 1, Verdict.CONSISTENT),
        (WEAK, 0, 1, 2, Verdict.NOT_SEEN),
        (WEAK, 0.1, 1, 2, Verdict.REFUTED),
        (MARGIN, -5, 2, 10, Verdict.HOLDS),
        (MARGIN, -5, 2, 11, Verdict.CONSISTENT),
        (MARGIN, 5, 12, 20, Verdict.NOT_SEEN),
        (MARGIN, 11, 12, 20, Verdict.REFUTED),
    ],
)
def test_a_verdict_follows_from_the_interval(
    claim: Claim, low: float, value: float, high: float, expected: Verdict
) -> None:
    assert verdict(claim, Estimate(value, low, high, 200)) is expected
    assert verdict(claim, Estimate(value, low, high, 19)) is Verdict.TOO_FEW


def test_all_of_the_papers_claims_hold_where_they_are_planted() -> None:
    found = findings(planted(2000, seed=3))
    assert [finding.claim for finding in found] == list(CLAIMS)
    assert {finding.verdict for finding in found} == {Verdict.HOLDS}


def test_the_claims_are_refuted_where_the_opposite_is_planted() -> None:
    distances, shares = (200.0, 120.0, 90.0, 50.0, 100.0), (0.005, 0.1, 0.2, 0.3, 0.6)
    upside_down = dict(zip(AS_PAPER, zip(distances, shares, strict=True), strict=True))
    for finding in findings(planted(1000, seed=4, effects=upside_down)):
        assert finding.verdict is Verdict.REFUTED, finding


def test_equal_unsafe_behaviour_is_no_difference_and_meets_only_claims_that_allow_equality() -> None:
    alike = dict.fromkeys(AS_PAPER, (20.0, 0.1))  # the same luck decides in all algorithms
    for finding in findings(planted(300, seed=5, effects=alike)):
        if finding.claim.measure == "unsafe":
            allowed = (Verdict.CONSISTENT, Verdict.HOLDS) if finding.claim.equal else (Verdict.NOT_SEEN,)
            assert finding.verdict in allowed


def test_a_null_is_wrongly_called_seldom() -> None:
    alike = {"tmpud": (20.0, 0.1), "threshold(0.5)": (20.0, 0.1)}
    called = 0
    for seed in range(100):
        found = [f for f in findings(planted(60, seed, alike)) if f.claim.measure == "distance"]
        called += sum(f.verdict in (Verdict.HOLDS, Verdict.REFUTED) for f in found)
    assert called <= 15  # expected 5; more than 15 of 100 at 5 % each has a chance of 4e-5


def test_equal_distances_are_not_shorter_but_do_not_fall() -> None:
    names = ("no-com", "threshold(0.1)", "threshold(0.3)")
    found = {f.claim.text: f for f in findings([row(name, trial) for name in names for trial in range(40)])}
    assert found["No-com is shorter than Th(0.1)"].verdict is Verdict.NOT_SEEN
    assert found["distance does not fall from beta 0.1 to 0.3"].verdict is Verdict.HOLDS
    assert found["unsafe does not rise from beta 0.1 to 0.3"].verdict is Verdict.CONSISTENT


def test_two_hundred_safe_trials_do_not_show_a_margin_of_ten_per_thousand_and_a_thousand_do() -> None:
    for n, expected in ((200, Verdict.CONSISTENT), (1000, Verdict.HOLDS)):
        rows = [row(name, trial) for name in ("tmpud", "threshold(0.5)") for trial in range(n)]
        (near,) = (f for f in findings(rows) if f.claim.bound)
        assert (near.difference.value, near.verdict) == (0, expected)


def test_trials_with_a_tool_fault_are_left_out_of_a_comparison() -> None:
    rows = [row(name, trial) for name in ("tmpud", "threshold(0.5)") for trial in range(30)]
    rows += [row("tmpud", 30, status="SIM_CRASH", unsafe=True), row("threshold(0.5)", 30)]
    for finding in findings(rows):
        assert finding.difference.n == 30
        assert finding.difference.value == 0


def test_claims_on_algorithms_that_were_not_run_are_not_made() -> None:
    found = findings([row(name, trial) for name in ("tmpud", "other") for trial in range(30)])
    assert found == ()
    assert worst(found) is Verdict.TOO_FEW


def test_a_claim_is_as_good_as_its_weakest_part() -> None:
    found = findings(planted(200, seed=6))
    part = [f for f in found if f.verdict is Verdict.HOLDS]
    assert worst(part) is Verdict.HOLDS
    refuted = Finding(condition="", claim=STRICT, difference=Estimate(1, 1, 1, 99), verdict=Verdict.REFUTED)
    assert worst([refuted, *part]) is Verdict.REFUTED


def test_a_finding_is_json_and_holds_the_cross_check_for_unsafe_behaviour_alone() -> None:
    for finding in findings(planted(50, seed=7)):
        words = json.loads(json.dumps(finding.to_json(), allow_nan=False))
        assert (words["p_value"] is None) == (finding.claim.measure == "distance")
        assert words["verdict"] == finding.verdict.value
    nowhere = findings([row(name, 0, status="ERROR") for name in AS_PAPER])
    assert all(math.isnan(f.difference.value) and f.verdict is Verdict.TOO_FEW for f in nowhere)
    json.dumps([finding.to_json() for finding in nowhere], allow_nan=False)
