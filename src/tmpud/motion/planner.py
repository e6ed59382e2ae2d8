"""P^m (Sec. III and IV-C): from a transition to a path, a trajectory and controls."""

from __future__ import annotations

import numpy as np

from tmpud.dynamics import EGO, VehicleLimits
from tmpud.errors import InfeasibleMotionError
from tmpud.motion.drive import Drive
from tmpud.motion.mapping import RoadPoint, StateMapping
from tmpud.motion.path import Cross, Follow, Move
from tmpud.motion.path_planner import PathPlanner
from tmpud.motion.right_of_way import RightOfWay
from tmpud.motion.route import Route, build_route
from tmpud.motion.signals import Switched
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Control, FloatArray, Scene
from tmpud.symbols import TaskPlan, Transition
from tmpud.trajectory import Trajectory

REACHED = 0.15  # [m] the goal pose counts as reached this much before it
BEYOND = 60.0  # [m] how far the route goes on after the goal pose


class LaneMotionPlanner(PathPlanner):
    """Plans and drives one transition at a time on the lanes of a road network."""

    def __init__(
        self, network: RoadNetwork, mapping: StateMapping, limits: VehicleLimits = EGO, dt: float = 0.05
    ) -> None:
        super().__init__(network, mapping)
        self._limits, self._dt = limits, dt
        self._right_of_way = RightOfWay(network)
        self._drive: Drive | None = None

    @property
    def lights(self) -> Switched:
        """All that this planner remembers of the scenes it was shown: how long each light has been as it is."""
        return self._right_of_way.clock.switched

    @lights.setter
    def lights(self, switched: Switched) -> None:
        self._right_of_way.clock.switched = switched

    def where(self, scene: Scene, transition: Transition) -> RoadPoint:
        """Return the point of the transition's first lane beside which the ego is."""
        lane = self._network.segments[transition.state.segment].lane
        return RoadPoint(lane, self._network.lanes[lane].centre.project(scene.ego.pose.x, scene.ego.pose.y)[0])

    def _route(self, scene: Scene, transition: Transition, upcoming: TaskPlan) -> Route:
        here = self.where(scene, transition)
        moves = self.moves(here, transition)
        if moves is None:
            raise InfeasibleMotionError(f"no path does {transition.action} from {here.lane} at {here.station:.1f} m")
        goal = self.goal(here, transition)
        return build_route(self._network, moves, self._beyond(goal, upcoming), self._limits)

    def _beyond(self, goal: RoadPoint, upcoming: TaskPlan) -> list[Move]:
        """Return how the way goes on after the goal pose: as planned up to the next merge, then straight on."""
        moves: list[Move] = []
        at, action_by_lane = goal, {}
        for step in upcoming:
            if step.action.is_merge:
                break
            lane, next_lane = (self._network.segments[s.segment].lane for s in (step.state, step.next_state))
            if lane != next_lane or self._network.segments[step.next_state.segment].number == 0:
                action_by_lane[lane] = next_lane
        length = 0.0
        while length < BEYOND:
            lane_ = self._network.lanes[at.lane]
            if lane_.length - at.station > 0.1:
                moves.append(Follow(lane_, at.station, lane_.length))
            ways = self._network.outgoing(at.lane)
            planned = [way for way in ways if way.to_lane == action_by_lane.get(at.lane)]
            if not ways:
                break
            way = (planned or sorted(ways, key=lambda way: (way.action.value != "forward", way.to_lane)))[0]
            moves.append(Cross(way))
            at = RoadPoint(way.to_lane, 0.0)
            length = sum(move.length for move in moves)
        return moves

    # The tracking controller -----------------------------------------------------------------------------------

    def begin(self, transition: Transition, scene: Scene, upcoming: TaskPlan) -> None:
        """Take up a transition from where the ego is; ``upcoming`` is the rest of the plan."""
        self._drive = self._start(transition, scene, upcoming)

    def _start(self, transition: Transition, scene: Scene, upcoming: TaskPlan) -> Drive:
        route = self._route(scene, transition, upcoming)
        guide = None
        if transition.action.is_merge:
            here = self.where(scene, transition)
            guide = build_route(self._network, (), self._beyond(here, ()), self._limits)
        return Drive(route, guide, self._right_of_way, self._limits)

    def control(self, scene: Scene) -> Control:
        """Return the command that follows the path of the transition being driven."""
        if self._drive is None:
            raise InfeasibleMotionError("control() before begin(): no transition is being driven")
        self._right_of_way.observe(scene)
        return self._drive.control(scene, self._dt)

    def reached(self) -> bool:
        """Whether the ego is at x'."""
        return self._drive is not None and self._drive.remaining <= REACHED

    # The trajectory for the estimate ---------------------------------------------------------------------------

    def trajectory(
        self, transition: Transition, scene: Scene, times: FloatArray, speed: float | None = None
    ) -> Trajectory:
        """Return the ego's planned motion from where it is: the speed planner rolled out, or a constant speed."""
        self._right_of_way.observe(scene)
        drive = self._start(transition, scene, ())
        if speed is not None:
            stations, speeds = drive.station(scene) + speed * times, np.full(len(times), speed)
        else:
            stations, speeds = drive.roll_out(scene, times)
        poses = np.array([drive.route.pose_at(float(station)) for station in stations])
        return Trajectory(times, poses, speeds)
