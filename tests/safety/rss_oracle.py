"""The safe distance by Intel's ad-rss library, an independent implementation of RSS (extra ``peers``)."""

from __future__ import annotations

import warnings
from typing import Any

import pytest

from tmpud.safety.gaps import RssParameters

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # its binding registers a converter twice
    ad_rss: Any = pytest.importorskip("ad_rss", reason="needs the extra 'peers'")

_physics, _rss = ad_rss.physics, ad_rss.rss


def safe_distance(rear_speed: float, front_speed: float, parameters: RssParameters) -> float:
    """Return the library's distance [m] for two vehicles that drive the same way."""
    found = _physics.Distance(0.0)
    front, rear = _vehicle(front_speed, parameters), _vehicle(rear_speed, parameters)
    assert _rss.structured.calculateSafeLongitudinalDistanceSameDirection(front, rear, found)
    return float(found.mDistance)


def _vehicle(speed: float, parameters: RssParameters) -> Any:
    vehicle = _rss.core.RelativeObjectState()
    vehicle.object_type = _rss.world.ObjectType.OtherVehicle
    _fill(vehicle)
    dynamics, along = vehicle.dynamics, vehicle.dynamics.alpha_lon
    dynamics.response_time = _physics.Duration(parameters.response_time)
    dynamics.min_longitudinal_safety_distance = _physics.Distance(parameters.standing_gap)
    dynamics.max_speed_on_acceleration = _physics.Speed(100.0)
    along.accel_max = _physics.Acceleration(parameters.acceleration)
    along.brake_max = _physics.Acceleration(-parameters.most_braking)
    along.brake_min = along.brake_min_correct = _physics.Acceleration(-parameters.least_braking)
    dynamics.alpha_lat.brake_min = _physics.Acceleration(-1.0)
    velocity = vehicle.structured_object_state.velocity
    velocity.speed_lon_min = velocity.speed_lon_max = _physics.Speed(speed)
    velocity.speed_lat_min = velocity.speed_lat_max = _physics.Speed(0.0)
    return vehicle


def _fill(value: Any) -> None:
    """Set all that the longitudinal distance does not depend on, since the library refuses what is not a number."""
    for name in [name for name in dir(value) if not name.startswith("_") and name != "assign"]:
        part = getattr(value, name)
        if hasattr(part, "names"):  # an enumeration
            continue
        if isinstance(part, int) or hasattr(part, "Valid"):  # a count, or a quantity with a unit
            setattr(value, name, type(part)(1))
        else:
            _fill(part)
