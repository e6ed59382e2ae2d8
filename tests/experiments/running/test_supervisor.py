from __future__ import annotations

import pytest

from tests.experiments.running.works import task
from tmpud.experiments.running.supervisor import chunks
from tmpud.experiments.running.workers import Limits


@pytest.mark.parametrize(
    ("groups", "limits", "sizes"),
    [
        ([25, 25], Limits(jobs=4), [25, 25]),  # together, although two workers have nothing to do
        ([450], Limits(jobs=1), [150, 150, 150]),
        ([21], Limits(jobs=2, together=False), [11, 10]),
        ([30, 30, 30], Limits(jobs=2, together=False), [30, 30, 30]),  # none is more than half of all
        ([320], Limits(jobs=8, together=False), [40] * 8),
        ([3], Limits(jobs=8, together=False), [1, 1, 1]),
        ([320], Limits(jobs=2, together=False, recycle_after=100), [80] * 4),
        ([], Limits(jobs=2), []),
    ],
)
def test_tasks_that_start_from_the_same_stay_together_as_far_as_the_limits_say(
    groups: list[int], limits: Limits, sizes: list[int]
) -> None:
    todo = [task(f"{group}/{n}", shared=group) for group, count in enumerate(groups) for n in range(count)]
    parts = list(chunks(todo, limits))
    assert [len(part) for part in parts] == sizes
    assert sorted(one.key for part in parts for one in part) == sorted(one.key for one in todo)
    assert all(len({str(one.shared) for one in part}) == 1 for part in parts)


def test_works_that_share_the_same_are_told_apart() -> None:
    todo = [task("a", work="Where"), task("b", work="Noting"), task("c", work="Where")]
    assert [[one.key for one in part] for part in chunks(todo, Limits(jobs=1))] == [["a", "c"], ["b"]]
