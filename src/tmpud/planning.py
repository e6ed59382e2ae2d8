"""The task plan of a mission alone: no simulator and no numpy, so that it is quick."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tmpud.motion.mapping import StateMapping
from tmpud.motion.path_planner import PathPlanner
from tmpud.presets import Preset, preset_named
from tmpud.roads.loading import load_map
from tmpud.roads.network import RoadNetwork
from tmpud.roads.places import request as service_request
from tmpud.symbols import LazyCost, OptimisticSafe, ServiceRequest
from tmpud.task.asp_planner import AspPlanner, PlanReport
from tmpud.task.domain import Domain
from tmpud.task.facts import encodings


@dataclass(frozen=True, slots=True)
class Problem:
    """A service request on a map: what a task planner needs to answer it."""

    network: RoadNetwork
    request: ServiceRequest
    preset: Preset
    cost: LazyCost
    safe: OptimisticSafe

    @classmethod
    def of(
        cls, map_: str, start: str, goal: str, via: Sequence[str] = (), *, seed: int = 7, preset: str = "tmpud"
    ) -> Problem:
        """Read map and places; raises MapError or RequestError."""
        settings = preset_named(preset)
        network = load_map(map_, settings.segment_length)
        request = service_request(network, start, (goal,), via, seed)
        paths = PathPlanner(network, StateMapping(network, request, settings, seed))
        return cls(network, request, settings, LazyCost(paths.path_length), OptimisticSafe())

    def solve(self) -> PlanReport:
        """Return the optimal plan from the start; raises NoPlanError."""
        start = Domain(self.network, self.request).start_state()
        return AspPlanner(self.network, self.preset).solve(start, self.request, self.cost, self.safe)

    def dump(self, folder: Path) -> tuple[Path, ...]:
        """Write the encodings and the facts of the whole map into a folder; return the files for plain clingo."""
        start = Domain(self.network, self.request).start_state()
        planner = AspPlanner(self.network, self.preset, prune=False)
        texts = dict(encodings())
        texts["facts.lp"] = planner.instance(start, self.request, self.cost, self.safe)
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        return tuple(folder / name for name in texts)
