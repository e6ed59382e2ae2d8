"""The task plan of a mission alone: no simulator and no numpy, so that it is quick."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tmpud.errors import RulesError
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

if TYPE_CHECKING:
    from tmpud.task.rules import Rules

MOST_RULES = 1 << 20  # [bytes] of a file


@dataclass(frozen=True, slots=True)
class Problem:
    """A service request on a map: what a task planner needs to answer it."""

    network: RoadNetwork
    request: ServiceRequest
    preset: Preset
    cost: LazyCost
    safe: OptimisticSafe
    rules: Rules | None = None

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

    def with_rules(self, file: Path) -> Problem:
        """Return the same problem under a user's rules (``task.rules``); raises RulesError."""
        from tmpud.task.rules import read_rules  # takes its time

        try:
            if not file.is_file() or file.stat().st_size > MOST_RULES:
                raise RulesError(str(file), None, f"not a file of at most {MOST_RULES} bytes")
            text = file.read_text("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise RulesError(str(file), None, f"cannot be read: {getattr(error, 'strerror', None) or error}") from error
        return replace(self, rules=read_rules(text, str(file)))

    def solve(self) -> PlanReport:
        """Return the optimal plan from the start; raises NoPlanError."""
        start = Domain(self.network, self.request).start_state()
        planner = AspPlanner(self.network, self.preset, rules=self.rules)
        return planner.solve(start, self.request, self.cost, self.safe)

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
