"""One transition under way: where the ego is on its route, whom it follows, and what holds it up."""

from __future__ import annotations

import math

import numpy as np

from tmpud.dynamics import VehicleLimits
from tmpud.motion.leading import Obstacle, leader
from tmpud.motion.right_of_way import PATIENCE, RightOfWay
from tmpud.motion.route import Gate, Route
from tmpud.motion.speed import STANDING_GAP, acceleration
from tmpud.motion.tracking import Tracker
from tmpud.scene import Control, FloatArray, Scene

GATES_AHEAD = 40.0  # [m] stop lines further away are not thought of yet
ROLL = 0.1  # [s] of a step when the drive is looked at in advance
AT_LINE = 5.0  # [m] standing this near a line is waiting at it


class Drive:
    """One transition under way: route, tracker, and what holds the ego up."""

    def __init__(
        self,
        route: Route,
        guide: Route | None,
        right_of_way: RightOfWay,
        limits: VehicleLimits,
    ) -> None:
        self.route, self._guide = route, guide
        self._right_of_way = right_of_way
        self._tracker, self._limits = Tracker(route, limits), limits
        self._station: float | None = None
        self._standing = 0.0  # [s] before the next stop line
        self._standing_inside = 0.0  # [s] within a junction

    @property
    def remaining(self) -> float:
        return math.inf if self._station is None else self.route.end - self._station

    def station(self, scene: Scene) -> float:
        return self.route.project(scene.ego.pose.x, scene.ego.pose.y, self._station or 0.0)[0]

    def control(self, scene: Scene, dt: float) -> Control:
        ego = scene.ego
        self._station, offset = self.route.project(ego.pose.x, ego.pose.y, self._station or 0.0)
        ahead = self._leader(scene, self._station)
        wish = acceleration(self.route, self._station, ego.speed, ahead, self._stop(scene, self._station, ahead, dt))
        return self._tracker.control(ego, self._station, offset, wish, dt)

    def _leader(self, scene: Scene, station: float) -> list[Obstacle]:
        """Return who is followed: until the centre crosses the line of a merge, the origin lane's leader only."""
        crossing = self.route.line_crossing
        if self._guide is not None and crossing is not None and station < crossing:
            on_guide = self._guide.project(scene.ego.pose.x, scene.ego.pose.y)[0]
            found = leader(scene, self._guide, on_guide)
        else:
            found = leader(scene, self.route, station)
        return [found] if found else []

    def _stop(self, scene: Scene, station: float, ahead: list[Obstacle], dt: float) -> float | None:
        """Return how far the next line is that must not be crossed now [m]."""
        front = station + scene.ego.length / 2
        gates = [gate for gate in self.route.gates if -0.2 < gate.station - front < GATES_AHEAD]
        if not gates:
            self._standing = 0.0
        elif scene.ego.speed < 0.3 and gates[0].station - front < AT_LINE:
            self._standing += dt
        inside = next((gate for gate in self.route.gates if gate.station < front < gate.exit), None)
        if inside is not None and self._standing_inside < PATIENCE:
            room = self._right_of_way.room_inside(scene, inside.connection, front - inside.station)
            self._standing_inside += dt if scene.ego.speed < 0.3 else 0.0
            if scene.ego.speed**2 < 2 * self._limits.max_braking * room < math.inf:
                return room
        for gate in gates:
            distance = gate.station - front
            too_late = scene.ego.speed**2 > 2 * self._limits.max_braking * max(distance, 0.01)
            if not too_late and not self._may_pass(scene, gate, front, ahead):
                return distance
        return None

    def _may_pass(self, scene: Scene, gate: Gate, front: float, ahead: list[Obstacle]) -> bool:
        """Whether the ego may cross a line now, and would not have to stop in the junction behind it."""
        room = gate.exit - front + scene.ego.length + STANDING_GAP
        jammed = any(gate.station - front < o.gap < room and o.speed < 1.0 for o in ahead)
        distance = gate.station - front
        return not jammed and self._right_of_way.may_enter(scene, gate.connection, distance, self._standing)

    def roll_out(self, scene: Scene, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return stations and speeds (T,) at some times if all others keep their speed."""
        station, speed = self.station(scene), scene.ego.speed
        ahead = self._leader(scene, station)
        stop = self._stop(scene, station, ahead, 0.0)
        grid = [(0.0, station, speed)]
        for i in range(math.ceil(float(times[-1]) / ROLL)):
            moved = station - grid[0][1]
            now = [Obstacle(o.gap + o.speed * i * ROLL - moved, o.speed) for o in ahead]
            wish = acceleration(self.route, station, speed, now, None if stop is None else stop - moved)
            speed = max(speed + wish * ROLL, 0.0)
            station += speed * ROLL
            grid.append(((i + 1) * ROLL, station, speed))
        t, s, v = np.array(grid).T
        return np.interp(times, t, s), np.interp(times, t, v)
