import math

import numpy as np
import pytest

from tmpud.geometry import Pose
from tmpud.scene import Vehicles, VehicleState
from tmpud.trajectory import Trajectory, predict


def test_predicted_vehicles_drive_straight_or_on_circles() -> None:
    straight = VehicleState("a", Pose(1, 2, math.pi / 2), "", speed=3.0)
    turning = VehicleState("b", Pose(0, 0, 0), "", speed=math.pi, yaw_rate=math.pi / 2)  # radius 2
    poses = predict(Vehicles.of([straight, turning]), np.array([0.0, 1.0, 2.0]))
    assert poses.shape == (2, 3, 3)
    np.testing.assert_allclose(poses[0, :, :2], [[1, 2], [1, 5], [1, 8]], atol=1e-12)
    np.testing.assert_allclose(poses[1, :, :2], [[0, 0], [2, 2], [0, 4]], atol=1e-12)
    np.testing.assert_allclose(poses[1, :, 2], [0, math.pi / 2, math.pi])


def test_no_vehicles_are_predicted_as_none() -> None:
    assert predict(Vehicles.of([]), np.zeros(4)).shape == (0, 4, 3)


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
