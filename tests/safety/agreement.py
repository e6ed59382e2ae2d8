"""How far the shares agree: exact with quadrature, exact with shapely, sampled with exact. Any number of cases."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from shapely import box
from shapely.geometry import Polygon

from tmpud.safety.control_set import Controls, HalfPlane
from tmpud.safety.share import exact_share, sampled_share
from tmpud.scene import FloatArray

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


def random_case(rng: np.random.Generator, steering: bool, widest: float) -> tuple[HalfPlane, Controls]:
    """Return one line through a random rectangle's neighbourhood, often nearly level or upright."""
    low_a, low = -rng.uniform(0, 8), rng.uniform(-widest, widest)
    high_a, high = low_a + rng.uniform(0.1, 12), rng.uniform(-widest, widest)
    controls = Controls((low_a, high_a), (min(low, high) - 1e-3, max(low, high)), steering)
    by_a, by_turn = rng.normal(size=2) * 10 ** rng.uniform(-4, 6, size=2) * (rng.random(2) > 0.05)
    a, turn = rng.uniform(low_a - 2, high_a + 2), rng.uniform(*controls.turning) * 1.5
    limit = by_a * a + by_turn * (np.tan(turn) if steering else turn)
    return HalfPlane(*(np.array([value]) for value in (limit, by_a, by_turn))), controls


def quadrature(plane: HalfPlane, controls: Controls) -> float:
    """Integrate the clipped line over theta by Gauss-Legendre, piece by piece between its kinks."""
    limit, by_a, by_turn = (float(values[0]) for values in plane)
    (low_a, high_a), (low, high) = controls.acceleration, controls.turning
    kinks = [(limit - by_a * a) / by_turn for a in (low_a, high_a)] if by_turn else []
    turns = np.clip(np.arctan(kinks) if controls.steering else kinks, low, high)
    ends = np.sort([low, high, *np.atleast_1d(turns)])
    total = 0.0
    for start, end in pairwise(ends):
        turn = (start + end) / 2 + (end - start) / 2 * _NODES
        rest = limit - by_turn * (np.tan(turn) if controls.steering else turn)
        if by_a:
            cut = np.clip(rest / by_a, low_a, high_a)
            inside = (cut - low_a if by_a > 0 else high_a - cut) / (high_a - low_a)
        else:
            inside = (rest >= 0).astype(float)
        total += (end - start) / 2 * float(_WEIGHTS @ inside)
    return total / (high - low)


def polygon_share(plane: HalfPlane, controls: Controls) -> float:
    """Cut the rectangle of accelerations and yaw rates with shapely."""
    limit, by_a, by_turn = (float(values[0]) for values in plane)
    (low_a, high_a), (low, high) = controls.acceleration, controls.turning
    norm = np.hypot(by_a, by_turn)
    normal = np.array([by_a, by_turn]) / norm
    foot, along = normal * limit / norm, np.array([-normal[1], normal[0]])
    corners = [foot + 1e3 * along, foot - 1e3 * along, foot - 1e3 * (along + normal), foot + 1e3 * (along - normal)]
    rectangle = box(low_a, low, high_a, high)
    return float(rectangle.intersection(Polygon(corners)).area / rectangle.area)


def compare_exact_with_quadrature(n: int, seed: int) -> float:
    """Return the largest error in n cases, half of them steering up to +-0.6 rad, half yaw rates."""
    rng = np.random.default_rng(seed)
    cases = [random_case(rng, steering=bool(i % 2), widest=0.6) for i in range(n)]
    return max(abs(float(exact_share(*case)[0]) - quadrature(*case)) for case in cases)


def compare_exact_with_polygon(n: int, seed: int) -> float:
    """Return the largest error in n cases of yaw rates."""
    rng = np.random.default_rng(seed)
    cases = [random_case(rng, steering=False, widest=0.6) for _ in range(n)]
    cut = [case for case in cases if case[0].by_acceleration[0] or case[0].by_turning[0]]
    return max(abs(float(exact_share(*case)[0]) - polygon_share(*case)) for case in cut)


def compare_sampled_with_exact(n: int, seed: int, samples: int = 1_000_000) -> float:
    """Return the largest error of sampling in n cases."""
    rng = np.random.default_rng(seed)
    cases = [random_case(rng, steering=bool(i % 2), widest=0.6) for i in range(n)]
    return max(abs(float((sampled_share(*case, samples, rng) - exact_share(*case))[0])) for case in cases)


def as_planes(limit: FloatArray, by_acceleration: FloatArray, by_turning: FloatArray) -> HalfPlane:
    """Return half-planes of a common shape."""
    return HalfPlane(*np.broadcast_arrays(limit, by_acceleration, by_turning))
