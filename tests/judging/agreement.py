"""How often the overlap of boxes agrees with shapely, for any number of pairs."""

from __future__ import annotations

import numpy as np
import shapely

from tmpud.judging.boxes import Box, overlapping
from tmpud.scene import FloatArray, Vehicles


def random_vehicles(n: int, rng: np.random.Generator, spread: float = 6.0) -> Vehicles:
    zero = np.zeros(n)
    x, y = rng.uniform(-spread, spread, size=(2, n))
    length, width = rng.uniform(0.3, 12, size=n), rng.uniform(0.3, 3, size=n)
    names = tuple(map(str, range(n)))
    columns = x, y, zero, rng.uniform(-4, 4, size=n), zero, zero, zero, length, width
    return Vehicles.of_table(names, ("",) * n, np.stack(columns, axis=1))


def polygons(x: FloatArray, y: FloatArray, heading: FloatArray, length: FloatArray, width: FloatArray) -> FloatArray:
    """Return shapely's boxes of N vehicles."""
    along = np.array([1, 1, -1, -1]) * length[:, None] / 2
    left = np.array([1, -1, -1, 1]) * width[:, None] / 2
    cos, sin = np.cos(heading)[:, None], np.sin(heading)[:, None]
    corners = np.stack([x[:, None] + along * cos - left * sin, y[:, None] + along * sin + left * cos], axis=-1)
    return np.asarray(shapely.polygons(corners))


def compare_boxes_with_shapely(n: int, seed: int) -> tuple[int, int]:
    """Return how many of n random pairs the two disagree on, and how many overlap; contacts under 1 nm are left out."""
    rng = np.random.default_rng(seed)
    wrong = overlaps = 0
    for start in range(0, n, 100):
        others = random_vehicles(min(100, n - start), rng)
        box = Box(0.5, -0.5, rng.uniform(-4, 4), rng.uniform(1, 6), rng.uniform(1, 3))
        own = polygons(*(np.array([value]) for value in box))[0]
        theirs = polygons(others.x, others.y, others.heading, others.length, others.width)
        found = np.isin(np.arange(len(others)), overlapping(box, others))
        expected = shapely.intersects(own, theirs)
        clear = (
            np.where(expected, shapely.area(shapely.intersection(own, theirs)), shapely.distance(own, theirs)) > 1e-9
        )
        wrong += int(np.sum((found != expected) & clear))
        overlaps += int(expected.sum())
    return wrong, overlaps
