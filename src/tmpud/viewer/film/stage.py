"""The film's picture: the lanes around the ego, the town in a corner, and two lines of words below."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from tmpud.dynamics import EGO
from tmpud.geometry import Point, Pose
from tmpud.story import plan_name
from tmpud.symbols import TaskPlan
from tmpud.viewer.document import CAR
from tmpud.viewer.film.telling import Telling
from tmpud.viewer.film.traffic import Traffic
from tmpud.viewer.ground import stops
from tmpud.viewer.paths import Outlines
from tmpud.viewer.picture import CAR as GREY
from tmpud.viewer.picture import COLOURS, DRIVEN, RISK, ROAD, Area, draw_network, fitting
from tmpud.viewer.reasons import WORDS

Image = NDArray[np.uint8]  # (height, width, 3)
INCHES = (6.4, 4.0)
SCENE = (0.0, 0.16, 1.0, 0.84)  # left, bottom, width, height as shares of the picture
CORNER = (0.735, 0.655, 0.255, 0.33)
SPAN = 100.0, 100.0 * (INCHES[1] * SCENE[3]) / (INCHES[0] * SCENE[2])  # [m] of road in the scene
LIGHTS = {"r": "#c00000", "u": "#f2c200", "y": "#f2c200", "g": "#00905f", "G": "#00905f"}
LETTERS = 92  # in a line of words


class Stage:
    """Draws one picture after another; what does not move is drawn once for each place of the camera."""

    def __init__(self, outlines: Outlines, area: Area, plans: Iterable[TaskPlan], width: int) -> None:
        """Take the ``area`` that the camera will see, the ``plans`` to be shown, and the pictures' width [px]."""
        self._outlines = outlines
        self._routes = {plan: outlines(plan) for plan in plans}
        self._figure = Figure(figsize=INCHES, dpi=width / INCHES[0], facecolor="white")
        self._canvas: Any = FigureCanvasAgg(self._figure)
        self._scene, self._corner = self._figure.add_axes(SCENE), self._figure.add_axes(CORNER, animated=True)
        self._centre: Point | None = None
        self._stops: list[list[Any]] = []
        self._draw_town(area)
        self._figure.text(0.985, 0.043, "black: the ego", ha="right", va="center", fontsize=9)
        self._moving = _Moving(self._figure, self._scene, self._corner)

    def _draw_town(self, area: Area) -> None:
        for axes in (self._scene, self._corner):
            axes.set(xticks=(), yticks=())
        self._scene.axis("off")
        network = self._outlines.network
        if network is None:
            self._corner.set_visible(False)
            return
        draw_network(self._scene, network, area)
        nearby = [name for name, lane in network.lanes.items() if area.touches(lane.centre.points)]
        self._stops = [stop for name in nearby for stop in stops(network, name)]
        seen = [(area.left, area.bottom), (area.right, area.top)]
        town = Area.around([*seen, *(point for route in self._routes.values() for point in route)], 40.0)
        lanes = [lane.centre.points for lane in network.lanes.values() if town.touches(lane.centre.points)]
        self._corner.add_collection(LineCollection(lanes, colors=ROAD, linewidths=1.2))
        _show(self._corner, town)

    def picture(self, centre: Point, traffic: Traffic, telling: Telling, clock: str) -> Image:
        """Draw the traffic around a place, and what is told of it."""
        if centre != self._centre:
            self._look_at(centre)
        self._canvas.restore_region(self._still)
        self._moving.show_traffic(traffic, telling, _view(centre))
        self._moving.show_lights(traffic, self._stops)
        self._moving.show_plans(self._routes, telling)
        self._moving.say(_action(telling), fitting(telling.news, LETTERS), clock, telling)
        for axes, artist in self._moving.artists:
            axes.draw_artist(artist)
        return np.array(self._canvas.buffer_rgba())[..., :3]

    def _look_at(self, centre: Point) -> None:
        _show(self._scene, _view(centre))
        self._canvas.draw()
        self._still = self._canvas.copy_from_bbox(self._figure.bbox)
        self._centre = centre


class _Moving:
    """What changes from one picture to the next."""

    def __init__(self, figure: Figure, scene: Axes, corner: Axes) -> None:
        self.artists: list[tuple[Any, Artist]] = []
        self.lights = LineCollection([], linewidths=3.0, zorder=2, animated=True)
        self.plan, self.small_plan = _line(3.5), _line(2.0, animated=False)
        self.given_up = _line(3.5, linestyle=(0, (2, 1.5)), alpha=0.8)
        self.path = _line(1.6, color=DRIVEN)
        self.cars = PolyCollection([], edgecolors="white", linewidths=0.5, zorder=6, animated=True)
        self.dot = _line(0, marker="o", color=DRIVEN, markersize=5, markeredgecolor="white", animated=False)
        for artist in (self.lights, self.given_up, self.plan, self.path, self.cars):
            scene.add_artist(artist)
            self.artists.append((scene, artist))
        corner.add_artist(self.small_plan)
        corner.add_artist(self.dot)
        self.artists.append((figure, corner))  # above the cars
        self.words = [
            figure.text(x, y, "", ha=side, va="center", size=size, animated=True, parse_math=False)
            for x, y, side, size in ((0.015, 0.112, "left", 11), (0.015, 0.043, "left", 9), (0.985, 0.112, "right", 11))
        ]
        self.artists += [(figure, text) for text in self.words]

    def show_traffic(self, traffic: Traffic, telling: Telling, view: Area) -> None:
        seen = {name: car(pose, *CAR) for name, pose in traffic.others.items()}
        seen = {name: outline for name, outline in seen.items() if view.touches(outline)}
        self.cars.set_verts([*seen.values(), car(traffic.ego, EGO.length, EGO.width)])
        self.cars.set_facecolor([*(RISK if name == telling.risk else GREY for name in seen), DRIVEN])
        self.dot.set_data([traffic.ego.x], [traffic.ego.y])

    def show_lights(self, traffic: Traffic, places: Sequence[Sequence[Any]]) -> None:
        shown = [(place, LIGHTS.get(_letter(traffic, place))) for place in places]
        self.lights.set_segments([_ends(place) for place, colour in shown if colour])
        self.lights.set_color([colour for _, colour in shown if colour])

    def show_plans(self, routes: dict[TaskPlan, list[Point]], telling: Telling) -> None:
        for line, plan, number in (
            (self.plan, telling.plan, telling.number),
            (self.small_plan, telling.plan, telling.number),
            (self.given_up, telling.given_up, telling.number - 1),
        ):
            _trace(line, routes.get(plan, []))
            line.set_color(COLOURS[max(number, 0) % len(COLOURS)])
        _trace(self.path, telling.path)
        self.path.set_color(RISK if telling.pause else DRIVEN)

    def say(self, action: str, news: str, clock: str, telling: Telling) -> None:
        for text, words in zip(self.words, (action, news, clock), strict=True):
            text.set_text(words)
        self.words[1].set_color(RISK if telling.alarm else DRIVEN)


def car(pose: Pose, length: float, width: float) -> list[Point]:
    """Return a vehicle's outline, narrower where its front is."""
    ex, ey = math.cos(pose.heading), math.sin(pose.heading)
    front, half = length / 2, width / 2
    right = [(-front, -half), (front - 1.2, -half), (front, -half / 2)]
    corners = [*right, *((a, -b) for a, b in reversed(right))]
    return [(pose.x + a * ex - b * ey, pose.y + a * ey + b * ex) for a, b in corners]


def _view(centre: Point) -> Area:
    """Return what is to be seen around a place."""
    (x, y), (width, height) = centre, SPAN
    return Area(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _show(axes: Axes, area: Area) -> None:
    """Show an area, to scale, in the middle of axes that may have another shape."""
    box = axes.get_window_extent()
    scale = max((area.right - area.left) / box.width, (area.top - area.bottom) / box.height) / 2  # [m/px]
    x, y = (area.left + area.right) / 2, (area.bottom + area.top) / 2
    axes.set_xlim(x - scale * box.width, x + scale * box.width)
    axes.set_ylim(y - scale * box.height, y + scale * box.height)


def _line(width: float, *, animated: bool = True, **style: Any) -> Line2D:
    return Line2D([], [], linewidth=width, solid_capstyle="round", zorder=4, animated=animated, **style)


def _trace(line: Line2D, points: Sequence[Point]) -> None:
    line.set_data([x for x, _ in points], [y for _, y in points])


def _letter(traffic: Traffic, place: Sequence[Any]) -> str:
    """Return what the light shows at a piece of a stop line."""
    letters, link = traffic.signals.get(place[0], ""), place[1][0]
    return letters[link] if 0 <= link < len(letters) else ""


def _ends(place: Sequence[Any]) -> list[Point]:
    x0, y0, x1, y1 = (value / 100 for value in place[2:])
    return [(x0, y0), (x1, y1)]


def _action(telling: Telling) -> str:
    """Return what the car is about, in a few words."""
    if telling.number < 0:
        return ""
    name = f"plan {plan_name(telling.number)}"
    if telling.step is None or telling.safe is None:
        return name
    return f"{name}: {WORDS[telling.step.action][1]}, Safe = {telling.safe:.2f}"
