"""What the server's traffic lights show, told when it changes."""

from __future__ import annotations

from typing import Any

import carla

LETTERS = {
    carla.TrafficLightState.Red: "r",
    carla.TrafficLightState.Yellow: "y",
    carla.TrafficLightState.Green: "g",  # and give way: CARLA may show green to crossing traffic, too
}
OFF = "O"


class Lights:
    """All lights of a town, by the ids that they have in its map."""

    def __init__(self, world: Any) -> None:
        self._heads = [
            (light.get_opendrive_id(), light) for light in world.get_actors().filter("traffic.traffic_light")
        ]
        self._told: dict[str, str] | None = None

    def changed(self) -> dict[str, str] | None:
        """Return a letter for each light, None where it is the same as when last asked."""
        now = {sign: LETTERS.get(light.state, OFF) for sign, light in self._heads}
        if now == self._told:
            return None
        self._told = now
        return now
