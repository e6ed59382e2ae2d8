import json

import pytest

from tmpud.errors import TmpudError
from tmpud.experiments.running.tasks import DONE, Record
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS
from tmpud.experiments.trials.grid import Grid, Route, cells, rows
from tmpud.roads.loading import load_map
from tmpud.roads.places import request

SMALL = Grid(seeds=(3, 4))


def record(key: str, digest: str, **result: object) -> Record:
    return Record(key=key, digest=digest, status=DONE, result=result)


def test_every_combination_is_one_task_with_a_key_of_its_own() -> None:
    grid = Grid(missions=("paper", "random:3"), presets=("tmpud", "paper"), seeds=(3, 4))
    found = cells(grid)
    assert len(found) == 4 * 2 * 2 * 2 * len(ALGORITHMS)
    assert len({cell.task.key for cell in found}) == len(found)
    assert len({cell.task.digest for cell in found}) == len(found)


def test_all_algorithms_of_a_trial_share_one_town() -> None:
    towns: dict[tuple[str, int], set[str]] = {}
    for cell in cells(SMALL):
        towns.setdefault((cell.condition, cell.trial), set()).add(str(cell.task.shared))
    assert all(len(shared) == 1 for shared in towns.values())
    assert len(set(map(str, towns.values()))) == 4


def test_a_random_mission_is_written_as_positions_that_name_the_same_segments_again() -> None:
    network = load_map("millbrook")
    routes = {cell.task.shared["start"]: cell.task.shared for cell in cells(Grid(missions=("random:40",), seeds=(1,)))}
    assert len(routes) == 40
    for shared in routes.values():
        again = request(network, shared["start"], (shared["goal"],))
        x, y = map(float, shared["start"].split(","))
        pose = network.lanes[network.segments[again.start.segments[0]].lane].centre.pose_at(again.start.station or 0.0)
        assert (pose.x, pose.y) == pytest.approx((x, y), abs=0.01)


def test_rows_are_those_of_records_made_of_the_very_task() -> None:
    first, second, third = cells(SMALL)[:3]
    found = rows(
        SMALL,
        [
            record(first.task.key, first.task.digest, status="COLLISION", distance=80.0, unsafe=True, replans=2),
            record(second.task.key, "0" * 16, status="SUCCESS", distance=430.0, unsafe=False),
            Record(key=third.task.key, digest=third.task.digest, status="SIM_HANG", result={"message": "10 s"}),
        ],
    )
    crashed, hung = found
    assert (crashed.condition, crashed.algorithm, crashed.trial) == ("normal", "tmpud", 0)
    assert (crashed.status, crashed.distance, crashed.unsafe) == ("COLLISION", 80.0, True)
    assert crashed.details == {"replans": 2}
    assert (hung.status, hung.unsafe, hung.arrived) == ("SIM_HANG", False, False)


@pytest.mark.parametrize(
    ("grid", "said"),
    [
        (Grid(algorithms=("threshold",)), "threshold"),
        (Grid(algorithms=("threshold(2)",)), "BETA 0 to 1"),
        (Grid(presets=("fast",)), "there are tmpud"),
        (Grid(missions=("random:0",)), "random:N"),
        (Grid(missions=(Route("park1e_0", "nowhere"),)), "nowhere"),
        (Grid(maps=("elsewhere.net.xml",)), "elsewhere"),
    ],
)
def test_what_cannot_be_run_is_refused_before_anything_runs(grid: Grid, said: str) -> None:
    with pytest.raises(TmpudError) as caught:
        cells(grid)
    assert said in str(caught.value)


def test_a_grid_outlasts_its_way_through_json() -> None:
    grid = Grid(missions=("paper", Route("park1e_0", "high4n", ("mill4n",))), traffic={"light": 40}, seeds=(1, 2))
    assert Grid.from_json(json.loads(json.dumps(grid.to_json()))) == grid
