"""The ego on a CARLA server: a car with pedals and a steering wheel, and a sensor for what it touches."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

import carla
import numpy as np

from tmpud.errors import SimulatorError
from tmpud.geometry import Pose
from tmpud.roads.carla_coordinates import KMH, to_point, to_steer
from tmpud.simulators.carla.pedals import Pedals
from tmpud.simulators.carla.reader import box_of
from tmpud.simulators.carla.server import ROLE, Server, above
from tmpud.simulators.conventions import DT

MODEL = "vehicle.tesla.model3"
SETTLING = 20  # steps until a car that was put on the road stands


class Ego:
    """One car of ours. Commands are ours, too: accelerations, and steering angles to the left."""

    def __init__(self, server: Server, pose: Pose) -> None:
        self._server = server
        self._actor = self._spawned(pose)
        self.id: int = self._actor.id
        server.ours.add(self.id)
        box = box_of(self._actor)
        self._actor.set_transform(above(server, pose, box.centre))
        physics = self._actor.get_physics_control()
        self._largest = float(physics.wheels[0].max_steer_angle)  # [deg]
        self._curve = np.array([(point.x, point.y) for point in physics.steering_curve] or [(0.0, 1.0)]).T
        self._pedals, self._speed = Pedals(DT), 0.0
        self.place = pose[:2]
        self._events: deque[Any] = deque()  # filled by a thread of the client's
        self._touched: set[int] = set()
        self._sensor = self._listening()

    def _spawned(self, pose: Pose) -> Any:
        model = self._server.world.get_blueprint_library().find(MODEL)
        model.set_attribute("role_name", f"{ROLE} ego")
        actor = self._server.world.try_spawn_actor(model, above(self._server, pose))
        if actor is None:
            raise SimulatorError(f"the server does not spawn the ego at {pose.x:.1f}, {pose.y:.1f}: no room there")
        return actor

    def _listening(self) -> Any:
        world = self._server.world
        kind = world.get_blueprint_library().find("sensor.other.collision")
        kind.set_attribute("role_name", f"{ROLE} sensor")
        sensor = world.spawn_actor(kind, carla.Transform(), attach_to=self._actor)
        self._server.ours.add(sensor.id)
        sensor.listen(self._events.append)
        return sensor

    def command(self, acceleration: float, steering: float) -> None:
        """Command an acceleration [m/s^2] and a steering angle [rad] for the next step."""
        throttle, brake = self._pedals.press(acceleration, self._speed)
        grip = float(np.interp(abs(self._speed) * KMH, *self._curve))
        steer = max(-1.0, min(1.0, to_steer(steering, self._largest) / max(grip, 0.1)))
        self._actor.apply_control(carla.VehicleControl(throttle=throttle, steer=steer, brake=brake))

    def observe(self, snapshot: Any) -> None:
        """Take in where the ego is; SimulatorError where it is no more."""
        actor = snapshot.find(self.id)
        if actor is None:
            raise SimulatorError(f"the ego vanished from the server at frame {snapshot.frame}")
        place, velocity = actor.get_transform(), actor.get_velocity()
        yaw = math.radians(place.rotation.yaw)
        self._speed = velocity.x * math.cos(yaw) + velocity.y * math.sin(yaw)
        self.place = to_point(place.location.x, place.location.y)

    def contacts(self, frame: int) -> list[tuple[int, int]]:
        """Return (frame, other actor) of each actor that was touched for the first time, up to a frame.

        The sensor tells of a contact at each tick of it, and at times late or twice.
        """
        new = []
        for event in [self._events.popleft() for _ in range(len(self._events))]:
            if event.frame > frame:
                self._events.append(event)
            elif event.other_actor.id not in self._touched:
                self._touched.add(event.other_actor.id)
                new.append((event.frame, event.other_actor.id))
        return sorted(new)

    def stop_listening(self) -> None:
        """Take the sensor away."""
        self._sensor.stop()
        self._server.destroy([self._sensor.id])

    def leave(self) -> None:
        """Take sensor and car away."""
        self.stop_listening()
        self._server.destroy([self.id])
