"""CARLA's coordinates and tmpud's: the one place where signs and units change.

CARLA's are left-handed: x ahead, y to the right, yaw clockwise [deg] and not wrapped. Ours are OpenDRIVE's own: y to
the left, heading counter-clockwise in (-pi, pi]. A CARLA map has no offset: the origins are the same.
"""

from __future__ import annotations

import math

from tmpud.geometry import Point, Pose, wrap_angle

KMH = 3.6  # [km/h] that are 1 m/s


def to_point(x: float, y: float) -> Point:
    """Return where a location of CARLA's is; also turns velocities and accelerations."""
    return x, -y


def from_point(x: float, y: float) -> Point:
    """Return x and y of CARLA's location at a point; also turns velocities and accelerations."""
    return x, -y


def to_heading(yaw: float) -> float:
    """Return the heading of a yaw [deg]."""
    return wrap_angle(-math.radians(yaw))


def from_heading(heading: float) -> float:
    """Return the yaw [deg] of a heading, in [-180, 180)."""
    return -math.degrees(wrap_angle(heading))


def to_yaw_rate(angular_z: float) -> float:
    """Return the yaw rate [rad/s] of an angular velocity about CARLA's z axis [deg/s]."""
    return -math.radians(angular_z)


def to_pose(x: float, y: float, yaw: float, box: Point = (0.0, 0.0)) -> Pose:
    """Return the pose of the centre of an actor's box.

    ``box`` is where that centre lies from the actor's own origin, in CARLA's axes: ahead and to the right [m].
    """
    heading = to_heading(yaw)
    ahead, left = to_point(*box)
    x, y = to_point(x, y)
    cos, sin = math.cos(heading), math.sin(heading)
    return Pose(x + ahead * cos - left * sin, y + ahead * sin + left * cos, heading)


def from_pose(pose: Pose, box: Point = (0.0, 0.0)) -> tuple[float, float, float]:
    """Return x, y [m] and yaw [deg] of the actor whose box has its centre at a pose; the opposite of ``to_pose``."""
    ahead, left = to_point(*box)
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    origin = pose.x - ahead * cos + left * sin, pose.y - ahead * sin - left * cos
    return (*from_point(*origin), from_heading(pose.heading))


def to_steer(steering: float, largest: float) -> float:
    """Return CARLA's steer, in [-1, 1] and positive to the right, of a steering angle to the left [rad].

    ``largest`` is the wheels' largest angle [deg] (``WheelPhysicsControl.max_steer_angle``).
    """
    return max(-1.0, min(1.0, from_heading(steering) / largest))


def from_steer(steer: float, largest: float) -> float:
    """Return the steering angle to the left [rad] of CARLA's steer."""
    return to_heading(steer * largest)


def to_speed(limit: float) -> float:
    """Return a speed [m/s] of CARLA's limits [km/h]."""
    return limit / KMH
