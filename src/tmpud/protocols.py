"""Every seam of the system on one page. Each part can be replaced by anything that has these methods."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol

from tmpud.symbols import Cost, Safe, ServiceRequest, State, TaskPlan, Transition

if TYPE_CHECKING:
    from tmpud.scene import Control, Scene
    from tmpud.trajectory import Trajectory


class TaskPlanner(Protocol):
    """P^t: the best sequence of symbolic actions."""

    def plan(self, state: State, request: ServiceRequest, cost: Cost, safe: Safe) -> TaskPlan:
        """Return the optimal plan; raises NoPlanError where there is none."""
        ...


class MotionPlanner(Protocol):
    """P^m: paths, trajectories and controls for one transition at a time."""

    def path_length(self, transition: Transition) -> float:
        """Return A*(x, x') between the canonical poses of s and s' [m]; inf where it cannot be driven."""
        ...

    def lanes(self, transition: Transition) -> tuple[str, ...]:
        """Return the lanes the transition drives on, in order, those through junctions included."""
        ...

    def trajectory(
        self, transition: Transition, scene: Scene, times: Iterable[float], speed: float | None = None
    ) -> Trajectory:
        """Return the ego's planned motion along the transition from where it is in the scene.

        With a ``speed`` [m/s] it drives the same path at that constant speed, whatever the traffic does.
        """
        ...

    def control(self, scene: Scene) -> Control:
        """Return the command that follows the path of the transition being driven."""
        ...
