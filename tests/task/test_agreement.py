from hypothesis import given, settings
from hypothesis import strategies as st

from tests.task.agreement import compare


def test_clingo_dijkstra_and_enumeration_agree_on_random_road_graphs() -> None:
    tally = compare(200, seed=1)
    assert tally.mismatches == []
    assert tally.enumerated > tally.plans / 2
    assert 0 < tally.without_plan < tally.plans / 2


@given(st.integers(min_value=0))
@settings(max_examples=30)
def test_they_agree_on_whatever_graph_hypothesis_thinks_of(seed: int) -> None:
    assert compare(1, seed).mismatches == []
