import pytest

from tmpud.experiments.statistics.claims import CLAIMS, Claim
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, FIGURE4, LABELS, TABLE1, PaperCell

CONDITIONS = {**TABLE1, **FIGURE4}


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.text)
@pytest.mark.parametrize("condition", CONDITIONS)
def test_the_papers_own_numbers_meet_its_claims(condition: str, claim: Claim) -> None:
    def measure(cell: PaperCell) -> float:
        return cell.distance if claim.measure == "distance" else cell.per_1000

    first, second = (CONDITIONS[condition][name] for name in (claim.first, claim.second))
    difference = measure(first) - measure(second)
    assert difference <= claim.bound if claim.equal else difference < claim.bound


def test_there_are_thirty_cells_and_each_algorithm_has_its_label() -> None:
    assert sum(len(cells) for cells in TABLE1.values()) == 10
    assert sum(len(cells) for cells in FIGURE4.values()) == 20
    assert all(tuple(cells) == ALGORITHMS for cells in CONDITIONS.values())
    assert tuple(LABELS) == ALGORITHMS


def test_counts_are_comparable_per_thousand_trials() -> None:
    assert TABLE1["normal"]["no-com"].per_1000 == 240  # 48 of 200
    assert FIGURE4["high density, high acceleration"]["no-com"].per_1000 == 116
