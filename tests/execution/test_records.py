"""From the record of an estimate alone, and the header's settings, o_i(t) can be computed again."""

import json
from dataclasses import asdict, replace
from functools import cache
from itertools import chain
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.execution.scripted import estimate as scripted
from tests.execution.test_worked_case import SLOW, driven
from tests.safety.fakes import MERGELEFT, FakeMotion, car, scene
from tests.safety.test_estimator import NETWORK, VEHICLES
from tmpud.events import Estimated, Event, Header, from_json, to_json
from tmpud.execution.records import estimated
from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
from tmpud.safety.control_set import HalfPlane, controls
from tmpud.safety.estimator import SafeSetEstimator
from tmpud.safety.share import exact_share
from tmpud.scene import VehicleState
from tmpud.viewer.memory import preset_of

ROUNDING = 2e-5  # of a share whose half-plane was rounded to six digits


def logged(event: Event) -> Event:
    return from_json(json.loads(json.dumps(to_json(event), allow_nan=False)))


@cache
def settings(preset: Preset) -> Preset:
    """Return a preset as the header's settings tell it."""
    header = logged(Header(0.0, {}, {}, {"settings": asdict(preset)}))
    assert isinstance(header, Header)
    return preset_of(header.mission["settings"])


def record(others: list[VehicleState], preset: Preset) -> Estimated:
    estimator = SafeSetEstimator(preset, FakeMotion(0.02), NETWORK)
    event = logged(estimated(1.0, MERGELEFT, estimator.estimate(MERGELEFT, scene(*others), np.random.default_rng(0))))
    assert isinstance(event, Estimated)
    return event


def shares(event: Estimated, preset: Preset) -> np.ndarray:
    """Return o_i(t) (N, T) of the sets in a record."""
    everything = (1.0, 0.0, 0.0)
    rows = [[tuple(map(float, plane or everything)) for plane in row] for row in event.planes]
    table = np.array(rows).reshape(len(event.ids), len(event.trajectory), 3)
    return exact_share(HalfPlane(*np.moveaxis(table, 2, 0)), controls(settings(preset)))


@pytest.mark.parametrize(
    ("preset", "tolerance"),
    [(TMPUD, ROUNDING), (replace(RELEASED, share="exact"), ROUNDING), (PAPER, 0.1), (RELEASED, 0.1)],
    ids=["tmpud", "released, exact", "paper", "released"],
)
@given(others=st.lists(VEHICLES, max_size=4))
def test_the_share_of_the_recorded_set_is_o(preset: Preset, tolerance: float, others: list[VehicleState]) -> None:
    event = record(others, preset)
    np.testing.assert_allclose(
        shares(event, preset), np.reshape(event.o, (len(event.ids), len(event.trajectory))), atol=tolerance
    )


@pytest.mark.parametrize("preset", [TMPUD, PAPER, RELEASED])
def test_sets_that_are_all_of_the_controls_have_no_line(preset: Preset) -> None:
    event = record([car(28, 2, speed=0.0, lane="in_1"), car(20, 25, lane="in_1")], preset)
    planes = [plane for row in event.planes for plane in row]
    assert len(planes) == len(event.ids) * len(event.trajectory)
    assert None in planes
    assert any(planes)
    assert {o for o, plane in zip(chain.from_iterable(event.o), planes, strict=True) if plane is None} == {1.0}


def test_the_recorded_vehicles_are_those_that_were_predicted() -> None:
    turning = replace(car(28, 2, 0.3, speed=4.0, name="turning"), yaw_rate=0.2)
    event = record([turning, car(20, 25)], TMPUD)
    assert event.ids[0] == "turning"
    assert event.others[0] == (28.0, 2.0, 0.3, 4.0, 0.2)
    assert len(event.others) == len(event.ids)


def test_a_value_that_was_drawn_has_neither_vehicles_nor_sets() -> None:
    event = estimated(1.0, MERGELEFT, scripted(0.5))
    assert (event.safe, event.others, event.planes) == (0.5, (), ())


def test_a_whole_drive_tells_the_sets_of_each_of_its_estimates(blocks_net: Path) -> None:
    header, *events = map(logged, driven(blocks_net, "tmpud", SLOW))
    assert isinstance(header, Header)
    preset = preset_of(header.mission["settings"])
    found = [event for event in events if isinstance(event, Estimated) and event.ids]
    assert any(min(map(min, event.o)) < 1 for event in found)
    for event in found:
        np.testing.assert_allclose(shares(event, preset), event.o, atol=ROUNDING)
