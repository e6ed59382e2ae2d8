"""What the film tells while it shows the traffic, from moment to moment."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from tmpud.events import Estimated, Event, Executed, Finished, Judged, Planned, Refused
from tmpud.geometry import Point
from tmpud.story import plan_name
from tmpud.symbols import TaskPlan, Transition
from tmpud.viewer.film.clip import UNSAFE
from tmpud.viewer.reasons import WORDS

PAUSE = 2.0  # [s] for which the film stands still where an action is refused or something unsafe happens
STAYS = 4.0  # [s] for which news, and what they are about, are shown


@dataclass(frozen=True, slots=True, kw_only=True)
class Telling:
    """What is told from a time on."""

    time: float = 0.0  # [s] of the news
    number: int = -1  # of the plan in force
    plan: TaskPlan = ()
    given_up: TaskPlan = ()  # the plan before it
    step: Transition | None = None  # the action that was estimated last
    safe: float | None = None
    path: tuple[Point, ...] = ()  # the ego's planned motion
    worst: str | None = None  # the vehicle that set Safe
    risk: str | None = None  # the vehicle the news are about
    news: str = ""
    alarm: bool = False
    pause: float = 0.0  # [s] for which the film stands still

    def later(self, time: float) -> Telling:
        """Return what is left of it at a later time."""
        if time - self.time < STAYS:
            return self
        return replace(self, news="", alarm=False, risk=None, given_up=())


def tellings(events: Iterable[Event]) -> Iterator[tuple[float, Telling]]:
    """Yield what is told after each event that changes it, with its time."""
    now = Telling()
    for event in events:
        now = replace(now, pause=0.0)
        match event:
            case Planned():
                now = _planned(now, event)
            case Estimated(step=step, safe=safe, worst=worst):
                path = tuple((x, y) for _, x, y, _ in event.trajectory)
                now = replace(now, step=step, safe=safe, path=path, worst=worst)
            case Refused(step=step, safe=safe):
                because = f" because of {now.worst} (red)" if now.worst else ""
                news = f"{_doing(step)} is not safe enough: Safe = {safe:.2f}{because}"
                now = replace(now, time=event.time, news=news, alarm=True, risk=now.worst, pause=PAUSE)
            case Executed(step=step, outcome=outcome) if outcome != "done":
                now = replace(now, time=event.time, news=f"{_doing(step)} ended: {outcome}", alarm=True)
            case Executed(step=step):
                now = replace(now, time=event.time, news=f"{_doing(step)}: done", alarm=False, risk=None, given_up=())
            case Judged(kind=kind, vehicle=vehicle):
                news = f"{kind.replace('_', ' ')}, blame: {event.blame}. {event.detail}"
                pause = PAUSE if kind in UNSAFE else 0.0
                now = replace(now, time=event.time, news=news, alarm=True, risk=vehicle, pause=pause)
            case Finished(status=status, distance=distance):
                now = replace(
                    now, time=event.time, news=f"{status}: {distance:.0f} m driven", alarm=status != "SUCCESS"
                )
            case _:
                continue
        yield event.time, now


def _planned(now: Telling, event: Planned) -> Telling:
    number = now.number + 1
    if number:
        news = f"Replanned from {plan_name(number - 1)} to {plan_name(number)} because {event.reason}"
    else:
        news = f"Plan {plan_name(number)}: {math.fsum(map(float, event.cost)):.0f} m"
    return replace(
        now,
        time=event.time,
        number=number,
        plan=event.plan,
        given_up=now.plan if now.alarm else (),
        step=None,
        safe=None,
        path=(),
        news=news,
        alarm=False,
    )


def _doing(step: Transition) -> str:
    return WORDS[step.action][1].capitalize()
