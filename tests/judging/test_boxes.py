import math

import numpy as np
import pytest

from tests.judging import agreement
from tests.judging.drives import car
from tmpud.judging.boxes import Box, box_of, overlapping, part_of
from tmpud.scene import Vehicles


def test_overlaps_agree_with_shapely() -> None:
    wrong, overlaps = agreement.compare_boxes_with_shapely(10_000, seed=1)
    assert wrong == 0
    assert 2000 < overlaps < 8000


def test_no_vehicles_overlap_nothing() -> None:
    assert overlapping(Box(0, 0, 0, 4, 2), Vehicles.of([])) == []


def test_bumper_to_bumper_is_contact_and_a_millimetre_apart_is_none() -> None:
    others = Vehicles.of([car(4.7, name="a"), car(4.701, name="b"), car(0, 1.9, name="c"), car(0, -1.901, name="d")])
    assert overlapping(box_of(car(0)), others) == [0, 2]


@pytest.mark.parametrize(("front", "x"), [(True, 2.1), (False, -2.1)])
def test_the_ends_of_a_box_are_its_bumpers(front: bool, x: float) -> None:
    part = part_of(box_of(car(0, heading=0.0)), 0.5, front)
    np.testing.assert_allclose(part, (x, 0, 0, 0.5, 1.9))
    turned = part_of(box_of(car(0, heading=math.pi / 2)), 0.5, front)
    np.testing.assert_allclose(turned[:2], (0, x), atol=1e-12)
