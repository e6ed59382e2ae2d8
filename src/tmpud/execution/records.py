"""An estimate as an event: what was found, and what it was found from."""

from __future__ import annotations

from tmpud.events import Estimated, Plane
from tmpud.safety.control_set import SafeSets
from tmpud.safety.estimator import SafetyEstimate
from tmpud.scene import Vehicles
from tmpud.symbols import Transition


def estimated(time: float, step: Transition, estimate: SafetyEstimate) -> Estimated:
    """Return the record of an estimate made at a simulated time [s]."""
    path = zip(estimate.times.tolist(), estimate.trajectory.poses.tolist(), strict=True)
    return Estimated(
        time=time,
        step=step,
        safe=estimate.safe,
        worst=estimate.worst,
        min_t=estimate.min_t,
        ids=estimate.ids,
        o=tuple(map(tuple, estimate.o.tolist())),
        trajectory=tuple((t, x, y, heading) for t, (x, y, heading) in path),
        others=() if estimate.others is None else _states(estimate.others),
        planes=() if estimate.sets is None else _planes(estimate.sets),
    )


def _states(others: Vehicles) -> tuple[tuple[float, float, float, float, float], ...]:
    return tuple((car.x, car.y, car.heading, car.speed, car.yaw_rate) for car in others.bodies)


def _planes(sets: SafeSets) -> tuple[tuple[Plane, ...], ...]:
    """Return U_i^S(t) (N, T) as the coefficients of its half-plane, None where it is all of Delta x Theta."""
    coefficients = zip(*(values.tolist() for values in sets.plane), strict=True)
    return tuple(tuple(next(coefficients) if cut else None for cut in row) for row in sets.cut.tolist())
