"""How much of Delta x Theta a half-plane holds (Alg. 1, line 6): in closed form, or by sampling as the paper does.

For a fixed turn x the safe accelerations are a clipped line, so the share is the mean over theta of
``clip((slack - c x) / span, 0, 1)`` with c = ``by_turning`` and span = ``|by_acceleration|`` times the width of Delta.
It is 1 up to one turn (``full``), 0 beyond another (``none``), and the integral of a line between the two:
breakpoints are arctangents and the antiderivative of the tangent is -ln cos where theta is a steering angle.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tmpud.safety.control_set import Controls, HalfPlane
from tmpud.scene import FloatArray

Bound = FloatArray | float
_CHUNK = 1 << 13  # samples worked on at once: few enough for the processor's cache


def exact_share(plane: HalfPlane, controls: Controls) -> FloatArray:
    """Return the share of the controls in each half-plane, an array of the planes' shape.

    Where neither control has an effect, it is 1 or 0 as the limit is met or not.
    """
    low_a, high_a = controls.acceleration
    slack = plane.limit - np.minimum(plane.by_acceleration * low_a, plane.by_acceleration * high_a)
    span = np.abs(plane.by_acceleration) * (high_a - low_a)
    slope = np.abs(plane.by_turning)
    low, high = _mirrored(controls.turning, plane.by_turning)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        full = _clip(_turn_at(slack - span, slope, controls.steering), low, high)
        none = _clip(_turn_at(slack, slope, controls.steering), low, high)
        partial = _partial(full, none - full, slack, slope, span, controls.steering)
    return _clip((full - low + partial) / (high - low), 0.0, 1.0)


def sampled_share(plane: HalfPlane, controls: Controls, samples: int, rng: np.random.Generator) -> FloatArray:
    """Return the share of ``samples`` fresh random controls for each half-plane, an array of the planes' shape."""
    flat = HalfPlane(*(np.ravel(values) for values in plane))
    rows = max(1, _CHUNK // samples)
    counts = [
        _count(HalfPlane(*(values[at : at + rows, None] for values in flat)), controls, samples, rng)
        for at in range(0, flat.limit.size, rows)
    ]
    return np.asarray(np.concatenate([np.zeros(0), *counts]).reshape(plane.limit.shape) / samples)


def _count(rows: HalfPlane, controls: Controls, samples: int, rng: np.random.Generator) -> NDArray[np.intp]:
    """Return how many of the samples lie in each half-plane; the planes' shape is (K, 1)."""
    (low_a, high_a), (low, high) = controls.acceleration, controls.turning
    unit = rng.random((rows.limit.size, samples, 2))
    acceleration, turn = low_a + (high_a - low_a) * unit[..., 0], low + (high - low) * unit[..., 1]
    effect = np.tan(turn) if controls.steering else turn
    inside = rows.by_acceleration * acceleration + rows.by_turning * effect <= rows.limit
    return np.asarray(np.count_nonzero(inside, axis=1))


def _mirrored(turning: tuple[float, float], effect: FloatArray) -> tuple[Bound, Bound]:
    """Return Theta's ends, mirrored where turning left helps, so that the share always falls with the turn."""
    low, high = turning
    if low == -high:
        return turning
    return np.where(effect < 0, -high, low), np.where(effect < 0, -low, high)


def _turn_at(slack: FloatArray, slope: FloatArray, steering: bool) -> FloatArray:
    """Return the turn at which ``slope * x`` uses up the slack; beyond all turns where there is no slope."""
    effect = np.fmin(slack / slope, np.inf)  # 0 / 0 is all turns
    return np.arctan(effect) if steering else effect


def _partial(
    full: FloatArray, width: FloatArray, slack: FloatArray, slope: FloatArray, span: FloatArray, steering: bool
) -> FloatArray:
    """Return the integral of ``(slack - slope x) / span`` over theta from ``full`` on over ``width``.

    log1p keeps the difference of two logarithms precise where the width is tiny.
    """
    start = np.tan(full) if steering else full
    if steering:
        half = np.tan(width / 2)
        sine = 2 * half / (1 + half * half)
        rise = -np.log1p(-sine * (half + start)) - start * width  # 2 sin^2(width / 2) = sine * half
    else:
        rise = width**2 / 2  # integral of x - x(full)
    line = _clip((slack - slope * start) / span, 0.0, 1.0) * width - slope / span * rise
    return np.where((width > 1e-15) & (span > 0), line, 0.0)


def _clip(values: FloatArray, low: Bound, high: Bound) -> FloatArray:
    """Do as ``np.clip``, which takes longer for few values."""
    return np.minimum(np.maximum(values, low), high)
