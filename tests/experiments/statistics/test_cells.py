import json

import numpy as np
import pytest

from tests.experiments.planted import planted, row
from tmpud.experiments.statistics.cells import Cell, cells
from tmpud.experiments.statistics.intervals import wilson
from tmpud.experiments.statistics.pairing import pair
from tmpud.experiments.statistics.rows import TrialRow


def found(rows: list[TrialRow]) -> dict[str, Cell]:
    (paired,) = pair(rows)
    return {cell.algorithm: cell for cell in cells(paired, rows, np.random.default_rng(0), resamples=500)}


ROWS = [
    row("a", 0, distance=100.0, details={"collisions": {"crossing": 1}, "forced_stops": 0}),
    row("b", 0, distance=120.0),
    row("a", 1, distance=200.0, unsafe=True, details={"collisions": {}, "forced_stops": 2}),
    row("b", 1, distance=50.0, status="COLLISION", unsafe=True),
    row("a", 2, distance=7.0, status="SIM_HANG", unsafe=True, details={"collisions": {}, "forced_stops": 1}),
    row("b", 2, distance=140.0),
]


def test_a_tool_fault_is_neither_safe_nor_unsafe_and_is_counted() -> None:
    cell = found(ROWS)["a"]
    assert (cell.trials, cell.faults, cell.unsafe, cell.per_1000) == (3, 1, 1, wilson(1, 2).scaled(1000))
    assert cell.statuses == {"SIM_HANG": 1, "SUCCESS": 2}


def test_distances_are_over_the_trials_in_which_all_arrived_with_own_arrivals_beside() -> None:
    both = found(ROWS)
    assert [(both[name].distance.value, both[name].distance.n) for name in "ab"] == [(100.0, 1), (120.0, 1)]
    assert [(both[name].arrived, both[name].own_distance) for name in "ab"] == [(2, 150.0), (2, 130.0)]


def test_two_stops_in_a_trial_are_two_events_and_one_unsafe_trial() -> None:
    both = found(ROWS)
    assert both["a"].events == {"merge collisions": 0, "crossing collisions": 1, "forced stops": 2}
    assert both["b"].events == {}  # its rows tell of none


def test_cells_recover_what_was_planted() -> None:
    both = found(planted(3000, seed=1))
    for name, longer, unsafe in (("no-com", 0, 250), ("threshold(0.1)", 50, 130), ("tmpud", 95, 5)):
        cell = both[name]
        assert cell.per_1000.low < unsafe < cell.per_1000.high
        assert cell.distance.value == pytest.approx(430 + longer, abs=6)
        assert cell.distance.low < cell.distance.value < cell.distance.high


def test_a_cell_of_nothing_but_faults_is_json() -> None:
    cell = found([row("a", 0, status="ERROR")])["a"]
    words = json.loads(json.dumps(cell.to_json(), allow_nan=False))
    assert words["own_distance"] is words["distance"]["value"] is words["per_1000"]["value"] is None
    assert (words["trials"], words["faults"], words["per_1000"]["n"]) == (1, 1, 0)


@pytest.mark.parametrize("details", [{}, {"forced_stops": 1}, {"collisions": {"merge": 1}}])
def test_events_that_rows_tell_only_half_of_are_not_counted_as_none(details: dict[str, object]) -> None:
    assert found([row("a", 0, unsafe=True, details=details)])["a"].events == {}
