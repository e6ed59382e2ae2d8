"""What the programs of the traffic lights tell about the near future."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tmpud.roads.network import LaneConnection, RoadNetwork
from tmpud.scene import Scene

GREEN = "Gg"
Switched = Mapping[str, tuple[str, float]]  # light -> its letters and since when it shows them [s]


class SignalClock:
    """Watches the lights switch, and knows from their programs when crossing traffic will get green."""

    def __init__(self, network: RoadNetwork) -> None:
        self._network = network
        self.switched: Switched = {}  # never changed, but replaced
        self._seen: Mapping[str, str] | None = None  # the signals of the last scene

    def observe(self, scene: Scene) -> None:
        """Take note of the lights that switched; to be called at every step."""
        if scene.signals is self._seen:
            return
        self._seen = scene.signals
        switched = dict(self.switched)
        for light, letters in scene.signals.items():
            if light not in self._network.signals:
                continue  # nothing is known of its program
            if light not in switched:
                switched[light] = letters, self._began(light, letters, scene.time)
            elif switched[light][0] != letters:
                switched[light] = letters, scene.time
        self.switched = switched

    def _began(self, light: str, letters: str, now: float) -> float:
        """Return since when a light that is seen for the first time shows its letters, if it keeps to its program."""
        program = self._network.signals[light]
        position = (now - program.offset) % sum(duration for duration, _ in program.phases)
        for duration, shown in program.phases:
            if position < duration:
                return now - position if shown == letters else now
            position -= duration
        return now

    def until_crossing_green(self, connection: LaneConnection, now: float) -> float:
        """Return how long it takes until a foe that has red gets green while the connection has not [s].

        It is inf where the light's program does not say so, or shows letters that the program does not have.
        """
        light = connection.signal
        if light is None or light not in self.switched:
            return math.inf
        letters, since = self.switched[light]
        phases = self._network.signals[light].phases
        current = next((i for i, phase in enumerate(phases) if phase[1] == letters), None)
        if current is None:
            return math.inf
        foes = [self._network.connections[foe] for foe in connection.foes]
        waiting = [foe.link for foe in foes if foe.signal == light and letters[foe.link] not in GREEN]
        left = phases[current][0] - (now - since)
        for duration, shown in phases[current + 1 :] + phases[:current]:
            if shown[connection.link] not in GREEN and any(shown[link] in GREEN for link in waiting):
                return max(left, 0.0)
            left += duration
        return math.inf
