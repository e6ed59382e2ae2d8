import numpy as np
import pytest

from tmpud.geometry import Pose
from tmpud.scene import Body, Vehicles, VehicleState

CARS = Vehicles.of([VehicleState(name, Pose(x, 2.0, 0.1), "lane", speed=x) for name, x in (("a", 1.0), ("b", 5.0))])


def test_the_arrays_are_the_bodies_column_by_column() -> None:
    for name in Body._fields:
        assert getattr(CARS, name).tolist() == [getattr(body, name) for body in CARS.bodies]
    assert Vehicles((), (), ()).x.shape == (0,)


def test_the_arrays_cannot_be_changed_apart_from_the_bodies() -> None:
    with pytest.raises(ValueError, match="read-only"):
        CARS.x[0] = 9.0


def test_some_are_taken_with_all_that_is_theirs() -> None:
    some = CARS.take(CARS.speed > 2.0)
    assert (some.ids, some.lanes, some.bodies) == (("b",), ("lane",), [CARS.bodies[1]])
    assert len(CARS.take(np.array([False, False]))) == 0
