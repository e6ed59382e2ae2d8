"""How much of Delta x Theta a half-plane holds (Alg. 1, line 6): in closed form, or by sampling as the paper does.

For a fixed turn x the safe accelerations are a clipped line, so the share is the mean over theta of
``clip((slack - c x) / span, 0, 1)`` with c = ``by_turning`` and span = ``|by_acceleration|`` times the width of Delta.
It is 1 up to one turn, 0 beyond another, and the integral of a line between the two; where theta is a steering angle
and x its tangent, those turns are arctangents, and the integral of the tangent is -ln cos theta = ln(1 + x^2) / 2.
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
    least, most = _mirrored(controls.effects, plane.by_turning)
    low, high = (np.arctan(least), np.arctan(most)) if controls.steering else (least, most)  # as ``turn`` is worked out
    middle = plane.limit - plane.by_acceleration * ((low_a + high_a) / 2)
    reach = np.abs(plane.by_acceleration) * ((high_a - low_a) / 2)
    slack, slope = middle + reach, np.abs(plane.by_turning)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        full = _clip((middle - reach) / slope, least, most)  # x up to which every acceleration is safe
        none = _clip(slack / slope, least, most)  # x beyond which none is
        turn, width, integral = _between(full, none, controls.steering)
        partial = np.fmax((slack * width - slope * integral) / (2 * reach), 0.0)  # 0 / 0 where the line jumps
    return np.asarray(np.minimum((turn - low + partial) / (high - low), 1.0))


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


def _mirrored(ends: tuple[float, float], effect: FloatArray) -> tuple[Bound, Bound]:
    """Return a range's ends, mirrored where turning left helps, so that the share always falls with the turn."""
    low, high = ends
    if low == -high:
        return ends
    return np.where(effect < 0, -high, low), np.where(effect < 0, -low, high)


def _clip(x: FloatArray, least: Bound, most: Bound) -> FloatArray:
    """Limit x to a range; 0 / 0, where turning has no effect and all turns are safe, is its upper end."""
    return np.asarray(np.maximum(np.fmin(x, most), least))


def _between(start: FloatArray, end: FloatArray, steering: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return theta where x is ``start``, how far it is from there to ``end``, and the integral of x on that way.

    log1p and arctan2 keep the differences of two logarithms and two angles precise where they are tiny.
    """
    step = end - start
    if not steering:
        return start, step, step * (start + end) / 2
    rise = step * (start + end) / (1 + start * start)
    return np.arctan(start), np.arctan2(step, 1 + start * end), np.log1p(rise) / 2
