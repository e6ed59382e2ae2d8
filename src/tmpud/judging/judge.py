"""The judge of a trial: sees every step of the simulator and says what was unsafe."""

from __future__ import annotations

import math

from tmpud.judging.collisions import Collisions
from tmpud.judging.comfort import Comfort
from tmpud.judging.merges import MergeLog
from tmpud.judging.road_rules import Jumps, OffLane, Speeding
from tmpud.judging.rules import RECORDED, UNSAFE, JudgingRules, Kind, Rule, Verdict
from tmpud.judging.stop_lines import StopLines
from tmpud.judging.stops import ForcedStops, HardBraking
from tmpud.roads.network import RoadNetwork
from tmpud.scene import Scene

__all__ = ["Judge", "Verdict"]


class Judge:
    """Judges logged scenes alone; knows nothing of planner and simulator but the merges it is told of."""

    def __init__(self, network: RoadNetwork, rules: JudgingRules | None = None) -> None:
        rules = rules or JudgingRules()
        self._merges = MergeLog(network, rules)
        self._collisions = Collisions(rules, self._merges)
        self._comfort = Comfort(rules)
        self._followers: tuple[Rule, ...] = (ForcedStops(rules, self._merges), HardBraking(rules, self._merges))
        self._road: tuple[Rule, ...] = (
            StopLines(network, rules),
            OffLane(network, rules),
            Jumps(rules),
            Speeding(network, rules),
        )
        self._all = (*self._followers, *self._road)
        self._collided = False
        self.verdicts: tuple[Verdict, ...] = ()

    def merge_began(self, scene: Scene, origin_lane: str, target_lane: str, transition: str = "merge") -> None:
        """Take note that the ego starts to merge in this scene; ``transition`` names it in the record."""
        self._merges.began(scene, origin_lane, target_lane, transition)

    def observe(self, scene: Scene) -> tuple[Verdict, ...]:
        """Return the new verdicts of one step; to be called for each step of the simulator in order of time."""
        self._merges.observe(scene)
        self._comfort.observe(scene)
        new = list(self._collisions.observe(scene))
        self._collided = self._collided or bool(new)
        for rule in self._road if self._collided else self._all:
            new.extend(rule.observe(scene))
        self.verdicts += tuple(new)
        return tuple(new)

    @property
    def collisions(self) -> tuple[Verdict, ...]:
        return self._of({Kind.COLLISION})

    @property
    def forced_stops(self) -> tuple[Verdict, ...]:
        """Forced stops; none in a trial with a collision, which counts alone."""
        return () if self.collisions else self._of({Kind.FORCED_STOP})

    @property
    def violations(self) -> tuple[Verdict, ...]:
        """Broken rules of the road."""
        return self._of(set(Kind) - UNSAFE - RECORDED)

    @property
    def metrics(self) -> dict[str, float]:
        """Return what a drive is measured by; left out is what there was nothing to take from.

        The minimum time to collision is 0 where the ego collided, be it from the side or between two looks.
        """
        min_ttc, jerk = 0.0 if self.collisions else self._comfort.min_ttc, self._comfort.jerk
        return {
            "collisions": len(self.collisions),
            "forced_stops": len(self.forced_stops),
            "violations": len(self.violations),
            **({"min_ttc": round(min_ttc, 3)} if math.isfinite(min_ttc) else {}),
            **({"rms_jerk": round(jerk.rms, 3), "max_jerk": round(jerk.largest, 3)} if jerk.count else {}),
        }

    def _of(self, kinds: set[Kind]) -> tuple[Verdict, ...]:
        return tuple(verdict for verdict in self.verdicts if verdict.kind in kinds)
