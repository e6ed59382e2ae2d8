"""Makes a film of a recorded run: which pictures, and for how long each is shown."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from tmpud.viewer.film.camera import camera
from tmpud.viewer.film.clip import choose
from tmpud.viewer.film.stage import SPAN, Image, Stage
from tmpud.viewer.film.telling import Telling, tellings
from tmpud.viewer.film.traffic import Recording
from tmpud.viewer.intact import Intact
from tmpud.viewer.paths import Outlines
from tmpud.viewer.picture import Area

LAST = 1.5  # [s] for which the last picture stays


@dataclass(frozen=True, slots=True, kw_only=True)
class Cut:
    """What is shown, and how."""

    begin: float | None = None  # [s] since the drive began; None for both: a part worth seeing
    end: float | None = None
    fps: float | None = None  # pictures a second; None: what suits the file
    width: int = 640  # [px]; the height is 5/8 of it
    speed: float = 1.0  # simulated seconds a second


@dataclass(frozen=True, slots=True)
class Moment:
    """One picture of the film."""

    time: float  # [s] simulated
    telling: Telling
    stays: float  # [s]


class Film:
    """A film of a run; what cannot be shown of it is added to the run's ``missing``."""

    def __init__(self, run: Intact, cut: Cut) -> None:
        """Raise RunFileError or RequestError where there is nothing to show."""
        self.clip = choose(run, cut.begin, cut.end)
        self._cut = cut
        self._start = run.frames[0].time
        self._recording = Recording(run.frames)
        self._beats = list(tellings(run.events))
        begin, end = self._start + self.clip.begin, self._start + self.clip.end
        path = [(frame.time, frame.ego[0] / 100, frame.ego[1] / 100) for frame in run.frames]
        seen = [row for row in path if begin <= row[0] <= end] or path[:1]
        self._camera = camera([t for t, _, _ in seen], [(x, y) for _, x, y in seen], *SPAN)
        plans = {plan for _, now in self._beats for plan in (now.plan, now.given_up)}
        self._stage = Stage(Outlines(run), Area.around(self._camera.centres, max(SPAN)), plans, cut.width)

    def moments(self, fps: float) -> list[Moment]:
        """Return what is shown one after the other: the film stands still where something happens."""
        step = self._cut.speed / fps
        count = math.floor((self.clip.end - self.clip.begin) / step + 1e-9) + 1
        times = [self._start + self.clip.begin + step * number for number in range(count)]
        before = (
            times[0] - step if self.clip.begin else -math.inf
        )  # what led to the first plan belongs to the first picture
        shown = [moment for last, time in pairwise([before, *times]) for moment in self._between(last, time, 1 / fps)]
        end = shown[-1]
        return [*shown[:-1], Moment(end.time, end.telling, LAST)]

    def _between(self, last: float, time: float, stays: float) -> Iterator[Moment]:
        for moment, telling in self._beats:
            if last < moment <= time and telling.pause:
                yield Moment(moment, telling, telling.pause)
        past = [telling for moment, telling in self._beats if moment <= time]
        yield Moment(time, past[-1].later(time) if past else Telling(), stays)

    def draw(self, moment: Moment) -> Image:
        """Return the picture of a moment."""
        tenths = round(10 * max(moment.time - self._start, 0.0))
        clock = f"{tenths // 600}:{tenths % 600 / 10:04.1f}"
        traffic = self._recording.at(moment.time)
        return self._stage.picture(self._camera.at(moment.time), traffic, moment.telling, clock)

    @property
    def fps(self) -> float | None:
        return self._cut.fps
