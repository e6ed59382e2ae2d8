import numpy as np
import pytest

from tests.experiments.planted import AS_PAPER, planted, row
from tmpud.errors import RunFileError
from tmpud.experiments.statistics.pairing import pair


def test_the_order_of_rows_does_not_matter() -> None:
    rows = planted(30, seed=1, batches=3)
    shuffled = [rows[i] for i in np.random.default_rng(2).permutation(len(rows))]
    (first,), (second,) = pair(rows), pair(shuffled)
    assert first.algorithms == second.algorithms == tuple(sorted(AS_PAPER))
    for name in ("batches", "counted", "arrived", "unsafe", "distance"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def test_names_come_in_the_order_given_then_in_the_alphabets() -> None:
    rows = [row(name, 0, condition=condition) for condition in "cab" for name in ("x", "tmpud", "a")]
    pairs = pair(rows, conditions=("b", "unknown"), algorithms=("tmpud",))
    assert [paired.condition for paired in pairs] == ["b", "a", "c"]
    assert pairs[0].algorithms == ("tmpud", "a", "x")


def test_only_trials_in_which_all_arrived_compare_distances_and_faults_count_as_nothing() -> None:
    rows = [
        row("a", 0, distance=100.0),
        row("b", 0, distance=110.0),
        row("a", 1),
        row("b", 1, status="COLLISION", unsafe=True),
        row("a", 2, status="SIM_CRASH", unsafe=True),
        row("b", 2),
        row("a", 3),  # b was not run
    ]
    (paired,) = pair(rows)
    assert paired.compared.tolist() == [True, False, False, False]
    assert paired.clean.tolist() == [True, True, False, False]
    assert paired.distance[0].tolist() == [100.0, 110.0]
    assert paired.unsafe.tolist() == [[False, False], [False, True], [False, False], [False, False]]


def test_equal_trial_numbers_of_two_batches_are_two_trials() -> None:
    (paired,) = pair([row("a", 0, batch=0), row("a", 0, batch=1)])
    assert paired.batches.tolist() == [0, 1]


def test_a_trial_that_is_there_twice_is_named() -> None:
    with pytest.raises(RunFileError, match="normal, a, batch 0, trial 4: there twice"):
        pair([row("a", 4), row("a", 4)])
