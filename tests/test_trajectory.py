import math

import numpy as np
import pytest

from tmpud.geometry import Pose
from tmpud.scene import Vehicles, VehicleState
from tmpud.trajectory import Trajectory, predict


def test_predicted_vehicles_drive_straight_or_on_circles() -> None:
    straight = VehicleState("a", Pose(1, 2, math.pi / 2), "", speed=3.0)
    turning = VehicleState("b", Pose(0, 0, 0), "", speed=math.pi, yaw_rate=math.pi / 2)  # radius 2
    places, velocities = predict(Vehicles.of([straight, turning]), np.array([0.0, 1.0, 2.0]))
    np.testing.assert_allclose(places, [[1 + 2j, 1 + 5j, 1 + 8j], [0, 2 + 2j, 4j]], atol=1e-12)
    np.testing.assert_allclose(velocities, [[3j, 3j, 3j], [math.pi, math.pi * 1j, -math.pi]], atol=1e-12)


@pytest.mark.parametrize("yaw_rate", [5e-324, 1e-200, 1e-20, 1e-9, 1e-5])
def test_a_vehicle_that_hardly_turns_drives_on_all_but_straight(yaw_rate: float) -> None:
    times = np.array([0.0, 2.0])
    for turn in (yaw_rate, -yaw_rate):
        places, velocities = predict(Vehicles.of([VehicleState("a", Pose(3, 1, 0), "", 0.0, 10.0, turn)]), times)
        np.testing.assert_allclose(places, [[3 + 1j, 23 + (1 + 20 * turn) * 1j]], rtol=1e-9)
        np.testing.assert_allclose(velocities, [[10, 10 + 20j * turn]], rtol=1e-9)


def test_no_vehicles_are_predicted_as_none() -> None:
    assert [values.shape for values in predict(Vehicles.of([]), np.zeros(4))] == [(0, 4), (0, 4)]


def test_accelerations_and_yaw_rates_are_finite_differences_the_short_way_round() -> None:
    times = np.array([0.0, 0.5, 1.0])
    poses = np.array([[0, 0, 3.0], [0, 0, 3.1], [0, 0, 3.2 - math.tau]])
    trajectory = Trajectory(times, poses, np.array([5.0, 4.0, 3.0]))
    assert trajectory.accelerations == pytest.approx([-2, -2, -2])
    assert trajectory.yaw_rates == pytest.approx([0.2, 0.2, 0.2])


def test_a_single_instant_has_no_change() -> None:
    trajectory = Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([5.0]))
    assert trajectory.accelerations == pytest.approx([0.0])
    assert trajectory.yaw_rates == pytest.approx([0.0])
