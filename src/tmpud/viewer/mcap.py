"""A run as an MCAP file with Foxglove's messages, for the viewers that open these.

Topics: ``/map`` once; ``/traffic``, ``/ego`` and ``/tf`` (the ego in the map) for each frame; ``/plan`` for each plan;
``/trajectory`` and ``/safe`` for each estimate; ``/log`` for what happens. Times are simulated ones.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import Any

from tmpud.dynamics import EGO
from tmpud.errors import TmpudError
from tmpud.events import Estimated, Event, Frame
from tmpud.geometry import Point, Pose
from tmpud.viewer.aside import written_aside
from tmpud.viewer.document import CAR
from tmpud.viewer.film.telling import Telling, tellings
from tmpud.viewer.film.traffic import pose
from tmpud.viewer.intact import Intact
from tmpud.viewer.paths import Outlines
from tmpud.viewer.picture import CAR as GREY
from tmpud.viewer.picture import COLOURS, DRIVEN, ROAD, band

HEIGHT = 1.5  # [m] of every vehicle: the log holds none
MAP, ORIGIN = "map", Pose(0.0, 0.0, 0.0)
SAFE = {"safe": "number", "least": "number", "action": "string", "worst": "string"}
STATE = {"speed": "number", "x": "number", "y": "number", "heading": "number"}


class ExportError(TmpudError):
    """A run that cannot be exported."""


def write_mcap(run: Intact, file: Path) -> None:
    """Write what is intact of a run; raises ExportError, naming the extra, where the library is missing."""
    foxglove = _library()
    context, whole = foxglove.Context(), BytesIO()  # the library has no word for a full disk
    with foxglove.open_mcap(whole, context=context) as writer:
        writer.write_metadata("tmpud", {key: _text(value) for key, value in run.header.mission.items()})
        _Export(foxglove, context, Outlines(run)).write(run)
    with written_aside(file) as draft:
        draft.write_bytes(whole.getvalue())


def _library() -> Any:
    try:
        import foxglove
    except ImportError as error:
        raise ExportError('for MCAP install the extra: pip install "tmpud[mcap]"') from error
    return foxglove


class _Export:
    """The channels of one file."""

    def __init__(self, foxglove: Any, context: Any, outlines: Outlines) -> None:
        from foxglove import channels, messages

        self._m: Any = messages
        self._outlines = outlines
        self._scenes = {
            name: channels.SceneUpdateChannel(f"/{name}", context=context)
            for name in ("map", "traffic", "plan", "trajectory")
        }
        self._tf = channels.FrameTransformChannel("/tf", context=context)
        self._log = channels.LogChannel("/log", context=context)
        self._safe = foxglove.Channel("/safe", schema=_schema("Safe", SAFE), context=context)
        self._ego = foxglove.Channel("/ego", schema=_schema("Ego", STATE), context=context)
        self._seen: set[str] = set()  # vehicles that are in the scene

    def write(self, run: Intact) -> None:
        """Write everything in the order of time."""
        tell = list(tellings(run.events))
        events = sorted([*run.events, *run.frames], key=lambda event: event.time)
        self._roads(events[0].time if events else 0.0)
        for event in events:
            self._event(event)
        for (_, before), (time, now) in pairwise([(0.0, Telling()), *tell]):
            self._tell(time, before, now)

    def _event(self, event: Event) -> None:
        match event:
            case Frame():
                self._traffic(event)
                self._state(event.time, pose(event.ego), event.ego[3] / 100)
            case Estimated(time=time, step=step, safe=safe, worst=worst, min_t=least):
                row = {"safe": safe, "least": least, "action": str(step.action), "worst": worst or ""}
                self._safe.log(row, log_time=_ns(time))
                points = [(x, y) for _, x, y, _ in event.trajectory]
                self._show("trajectory", time, "trajectory", lines=[self._line(points, DRIVEN, 0.3)])

    def _tell(self, time: float, before: Telling, now: Telling) -> None:
        if now.number != before.number:
            colour = COLOURS[now.number % len(COLOURS)]
            self._show("plan", time, "plan", lines=[self._line(self._outlines(now.plan), colour, 0.8)])
        if (now.time, now.news) != (before.time, before.news):
            level = self._m.LogLevel.Warning if now.alarm else self._m.LogLevel.Info
            log = self._m.Log(timestamp=self._stamp(time), level=level, message=_text(now.news), name="tmpud")
            self._log.log(log, log_time=_ns(time))

    def _roads(self, time: float) -> None:
        network = self._outlines.network
        if network is None:
            return
        bands = [band(lane.centre.points, lane.width * 0.96) for lane in network.lanes.values()]
        corners = [self._point(x, y, 0.0) for outline in bands for x, y in _triangles(outline)]
        lanes = self._m.TriangleListPrimitive(points=corners, color=self._colour(ROAD), pose=self._pose(ORIGIN, 0.0))
        self._show("map", time, "lanes", triangles=[lanes])

    def _traffic(self, frame: Frame) -> None:
        rows = {_text(name): row for name, row in zip(frame.ids, frame.others, strict=True)}
        when, m = self._stamp(frame.time), self._m
        cubes = {f"vehicle {name}": self._cube(pose(row), CAR, GREY) for name, row in rows.items()}
        cubes["ego"] = self._cube(pose(frame.ego), (EGO.length, EGO.width), DRIVEN)
        entities = [m.SceneEntity(timestamp=when, frame_id=MAP, id=name, cubes=[cube]) for name, cube in cubes.items()]
        now = set(cubes)
        gone = [m.SceneEntityDeletion(timestamp=when, id=name) for name in sorted(self._seen - now)]
        self._seen = now
        self._scenes["traffic"].log(m.SceneUpdate(entities=entities, deletions=gone), log_time=_ns(frame.time))

    def _state(self, time: float, ego: Pose, speed: float) -> None:
        row = {"speed": speed, "x": ego.x, "y": ego.y, "heading": ego.heading}
        self._ego.log(row, log_time=_ns(time))
        place = self._m.FrameTransform(
            timestamp=self._stamp(time),
            parent_frame_id=MAP,
            child_frame_id="ego",
            translation=self._m.Vector3(x=ego.x, y=ego.y, z=0.0),
            rotation=self._turn(ego.heading),
        )
        self._tf.log(place, log_time=_ns(time))

    def _show(self, channel: str, time: float, name: str, **shapes: Any) -> None:
        entity = self._m.SceneEntity(timestamp=self._stamp(time), frame_id=MAP, id=name, **shapes)
        self._scenes[channel].log(self._m.SceneUpdate(entities=[entity]), log_time=_ns(time))

    def _cube(self, place: Pose, size: tuple[float, float], colour: str) -> Any:
        box = self._m.Vector3(x=size[0], y=size[1], z=HEIGHT)
        return self._m.CubePrimitive(pose=self._pose(place, HEIGHT / 2), size=box, color=self._colour(colour))

    def _line(self, points: Sequence[Point], colour: str, width: float) -> Any:
        drawn = [self._point(x, y, 0.05) for x, y in points]
        return self._m.LinePrimitive(
            points=drawn, color=self._colour(colour), thickness=width, pose=self._pose(ORIGIN, 0.0)
        )

    def _pose(self, place: Pose, z: float) -> Any:
        position = self._m.Vector3(x=place.x, y=place.y, z=z)
        return self._m.Pose(position=position, orientation=self._turn(place.heading))

    def _turn(self, heading: float) -> Any:
        return self._m.Quaternion(x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))

    def _point(self, x: float, y: float, z: float) -> Any:
        return self._m.Point3(x=x, y=y, z=z)

    def _colour(self, colour: str) -> Any:
        r, g, b = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
        return self._m.Color(r=r, g=g, b=b, a=1.0)

    def _stamp(self, time: float) -> Any:
        sec, nsec = divmod(_ns(time), 10**9)
        return self._m.Timestamp(sec=sec, nsec=nsec)


def _triangles(outline: Sequence[Point]) -> list[Point]:
    """Return the corners of the triangles that make up a lane's outline: its left side, then back along its right."""
    half = len(outline) // 2
    left, right = outline[:half], outline[: half - 1 : -1]
    quads = zip(pairwise(left), pairwise(right), strict=True)
    return [corner for (a, b), (c, d) in quads for corner in (a, b, c, b, d, c)]


def _schema(title: str, properties: Mapping[str, str]) -> dict[str, Any]:
    fields = {name: {"type": kind} for name, kind in properties.items()}
    return {"title": title, "type": "object", "properties": fields}


def _ns(time: float) -> int:
    return round(time * 1e9)


def _text(value: Any) -> str:
    """Return text that can be written as UTF-8."""
    return str(value).encode(errors="replace").decode()
