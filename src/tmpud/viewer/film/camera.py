"""Where the camera looks: it stands still as long as the ego stays well within the picture, then it glides on.

A camera at rest is easier to follow than one that moves with the car, and its pictures take far less space.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from tmpud.geometry import Point

INNER = 0.6  # the share of the picture's width and height in which the ego stays
GLIDE = 1.5  # [s] of the film from one shot to the next


@dataclass(frozen=True, slots=True)
class Camera:
    """Shots, each from a time on and with the place in the picture's middle."""

    begins: tuple[float, ...]
    centres: tuple[Point, ...]
    glide: float  # [s]

    def at(self, time: float) -> Point:
        """Return the place in the middle of the picture."""
        shot = max(bisect_right(self.begins, time + self.glide / 2) - 1, 0)
        there = self.centres[shot]
        share = (time - self.begins[shot]) / self.glide + 0.5
        if shot == 0 or share >= 1.0:
            return there
        here, eased = self.centres[shot - 1], share * share * (3 - 2 * share)
        return here[0] + eased * (there[0] - here[0]), here[1] + eased * (there[1] - here[1])


def camera(times: Sequence[float], path: Sequence[Point], width: float, height: float, glide: float = GLIDE) -> Camera:
    """Return a camera that keeps a path [m] within pictures of this size [m]; each shot takes in all it can."""
    begins: list[float] = []
    centres: list[Point] = []
    low = high = path[0]
    for time, (x, y) in zip(times, path, strict=True):
        low, high = (min(low[0], x), min(low[1], y)), (max(high[0], x), max(high[1], y))
        beyond = high[0] - low[0] > INNER * width or high[1] - low[1] > INNER * height
        if beyond or not begins:
            low = high = (x, y)
            begins.append(time)
            centres.append(low)
        centres[-1] = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2
    return Camera(tuple(begins), tuple(centres), glide)
