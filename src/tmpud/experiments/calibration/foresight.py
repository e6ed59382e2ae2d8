"""Whether the learned worlds foretell the full simulation: their unsafe shares against merges in a town's traffic.

The worlds were learned on a straight road with one neighbour (low density) or three (high density). A merge in the town
is put to the condition that has as many neighbours in the same area; acceleration is not told apart, since the town's
drivers have none of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from tmpud.experiments.calibration.scores import REACH
from tmpud.experiments.reports.table import NOTHING, Table
from tmpud.experiments.running.tasks import DONE, Record
from tmpud.experiments.statistics.intervals import Estimate, wilson

DENSITIES = {1: "low density", 3: "high density"}  # neighbours -> how the learned conditions begin


class Check(NamedTuple):
    """The merges of a town that had so many neighbours."""

    neighbours: int
    foretold: float | None  # unsafe share in the learned world; None where none was learned for so many
    seen: Estimate  # unsafe share in the town

    @property
    def holds(self) -> bool | None:
        """Whether the foretold share lies within the town's 95 % interval."""
        return None if self.foretold is None else self.seen.low <= self.foretold <= self.seen.high

    @property
    def off(self) -> float | None:
        """By how much the foretold share is above the town's."""
        return None if self.foretold is None else self.foretold - self.seen.value

    def to_json(self) -> dict[str, Any]:
        return {**self._asdict(), "seen": self.seen.to_json(), "holds": self.holds}


def checks(records: Iterable[Record], world: Mapping[str, Any]) -> tuple[Check, ...]:
    """Return for each number of neighbours what was foretold and what happened; local merges are left out."""
    counts: dict[int, list[bool]] = {}
    for record in records:
        if record.status == DONE and not record.key.startswith("local/"):
            for row in record.result["merges"]:
                counts.setdefault(row["neighbours"], []).append(row["unsafe"])
    return tuple(Check(n, _foretold(world, n), wilson(sum(found), len(found))) for n, found in sorted(counts.items()))


def _foretold(world: Mapping[str, Any], neighbours: int) -> float | None:
    """Return the unsafe share of the learned conditions with so many neighbours; alone on the road none is unsafe."""
    if not neighbours:
        return 0.0
    if neighbours not in DENSITIES:
        return None
    samples = (
        row["samples"]["outcome"] for name, row in world["conditions"].items() if name.startswith(DENSITIES[neighbours])
    )
    outcomes = "".join(samples)
    return 1.0 - outcomes.count("m") / len(outcomes)


def check_table(found: Iterable[Check]) -> Table:
    """Return the checks as a table."""
    columns = ("neighbours", "merges", "unsafe, foretold", "unsafe in the town", "within the interval", "off by")
    rows = tuple(
        (
            str(check.neighbours),
            str(check.seen.n),
            NOTHING if check.foretold is None else f"{check.foretold:.3f}",
            f"{check.seen.value:.3f} [{check.seen.low:.3f}, {check.seen.high:.3f}]",
            NOTHING if check.holds is None else "yes" if check.holds else "no",
            NOTHING if check.off is None else f"{check.off:+.3f}",
        )
        for check in found
    )
    notes = (f"Neighbours: within {REACH:g} m before and behind the ego, on its own lane or beside it.",)
    return Table("What the learned worlds foretell, and the town", columns, rows, notes)
