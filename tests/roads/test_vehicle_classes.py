from __future__ import annotations

import pytest

from tmpud.errors import MapError
from tmpud.roads.vehicle_classes import names_cars, open_to_cars
from tmpud.roads.xml_reading import Element


def lane(**attributes: str) -> Element:
    return Element("lane", attributes, "town.net.xml", 7)


@pytest.mark.parametrize(
    ("attributes", "is_open"),
    [
        ({}, True),
        ({"allow": "passenger taxi"}, True),
        ({"allow": "all"}, True),
        ({"allow": "bus bicycle"}, False),
        ({"disallow": "pedestrian tram"}, True),
        ({"disallow": "all"}, False),
        ({"disallow": "passenger"}, False),
        ({"allow": "", "disallow": ""}, True),
        ({"allow": "bus", "disallow": "tram"}, False),  # SUMO ignores disallow beside allow
    ],
)
def test_a_lane_is_open_to_cars_by_sumo_s_rules(attributes: dict[str, str], is_open: bool) -> None:
    assert open_to_cars(lane(**attributes)) is is_open


def test_cars_may_change_lanes_unless_the_lane_names_others_only() -> None:
    assert names_cars(lane(), "changeLeft")
    assert not names_cars(lane(changeLeft="authority"), "changeLeft")


def test_a_class_that_sumo_does_not_have_is_refused() -> None:
    with pytest.raises(MapError, match="'cars' is not a vehicle class"):
        open_to_cars(lane(disallow="cars"))
