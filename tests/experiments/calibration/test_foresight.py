import pytest

from tmpud.experiments.calibration.foresight import check_table, checks
from tmpud.experiments.calibration.scores import neighbours_of
from tmpud.experiments.running.tasks import DONE, SIM_HANG, Record
from tmpud.geometry import Pose
from tmpud.scene import Scene, Vehicles, VehicleState

WORLD = {
    "conditions": {
        "low density, low acceleration": {"samples": {"outcome": "mmmm"}},
        "low density, high acceleration": {"samples": {"outcome": "mmcs"}},
        "high density, low acceleration": {"samples": {"outcome": "cm"}},
        "high density, high acceleration": {"samples": {"outcome": "cc"}},
    }
}


def record(key: str, rows: list[tuple[int, bool]], status: str = DONE, gap: float | None = None) -> Record:
    merges = [{"neighbours": n, "unsafe": unsafe, "scores": {"gap": gap}} for n, unsafe in rows]
    return Record(key=key, digest="", status=status, result={"merges": merges})


def car(name: str, x: float, y: float, heading: float = 0.0) -> VehicleState:
    return VehicleState(name, Pose(x, y, heading), "lane")


def test_neighbours_are_those_along_the_ego_on_its_lane_or_beside_it() -> None:
    near = [car("ahead", 24, 0), car("beside", -3, 3.2)]
    far = [car("too far", 26, 0), car("two lanes off", 0, 6.4), car("oncoming", 5, 3.2, 3.1)]
    scene = Scene(0.0, car("ego", 0, 0), Vehicles.of([*near, *far]), {})
    assert neighbours_of(scene) == 2


def test_each_number_of_neighbours_is_put_to_its_learned_conditions() -> None:
    rows = [(0, False)] * 30 + [(1, False)] * 30 + [(1, True)] * 10 + [(2, True)] * 4 + [(3, False)] * 50
    alone, one, two, three = checks([record("millbrook/120/1", rows), record("local/x/1", [(7, True)])], WORLD)
    assert (alone.foretold, alone.holds) == (0.0, True)
    assert (one.foretold, one.seen.value, one.holds) == (0.25, 0.25, True)
    assert (two.foretold, two.holds) == (None, None)
    assert three.foretold == pytest.approx(0.75)
    assert three.holds is False
    assert [row[-2:] for row in check_table([one, two, three]).rows] == [
        ("yes", "+0.000"),
        ("-", "-"),
        ("no", "+0.750"),
    ]


def test_local_merges_are_weighted_by_the_gaps_of_the_towns() -> None:
    local = [
        record("local/x/1", [(1, True)] * 3 + [(1, False)], gap=-1.0),
        record("local/x/2", [(1, False)] * 3 + [(1, True)], gap=5.0),
        record("local/x/3", [(1, False)] * 4, gap=None),
    ]
    town = [
        record("millbrook/120/1", [(1, False)] * 8, gap=None),
        record("millbrook/120/2", [(1, False), (1, True)], gap=-1.0),
        record("millbrook/120/3", [(2, True)], gap=6.0),
    ]
    one, two = checks([*local, *town], WORLD)
    assert one.at_gaps == pytest.approx((8 * 0.0 + 2 * 0.75) / 10)
    assert two.at_gaps == pytest.approx(0.25)
    assert checks(town, WORLD)[0].at_gaps is None


def test_a_drive_that_met_a_fault_counts_for_nothing() -> None:
    assert checks([record("millbrook/120/1", [(1, True)], SIM_HANG)], WORLD) == ()
