"""Whether the learned worlds foretell the full simulation: their unsafe shares against merges in a town's traffic.

The worlds were learned on a straight road with one neighbour (low density) or three (high density). A merge in the town
is put to the condition that has as many neighbours in the same area; acceleration is not told apart, since the town's
drivers have none of their own. Where the shares differ, the gaps say why: local merges, weighted so that they have the
gaps of the town's, foretell them too, and miss only what is not a matter of where the neighbours are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tmpud.experiments.calibration.measures import Truth, isotonic
from tmpud.experiments.calibration.scores import REACH
from tmpud.experiments.reports.table import NOTHING, Table, interval
from tmpud.experiments.running.tasks import DONE, Record
from tmpud.experiments.statistics.intervals import Estimate, wilson
from tmpud.scene import FloatArray

Row = Mapping[str, Any]  # a merge, as ``scenes.merge_rows`` says

DENSITIES = {1: "low density", 3: "high density"}  # neighbours -> how the learned conditions begin


class Check(NamedTuple):
    """The merges of a town that had so many neighbours."""

    neighbours: int
    foretold: float | None  # unsafe share in the learned world; None where none was learned for so many
    at_gaps: float | None  # unsafe share of local merges with the gaps that these had; None without local merges
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
    """Return for each number of neighbours what was foretold and what happened."""
    local: list[Row] = []
    town: dict[int, list[Row]] = {}
    for record in records:
        for row in record.result["merges"] if record.status == DONE else ():
            (local if record.key.startswith("local/") else town.setdefault(row["neighbours"], [])).append(row)
    by_gap = isotonic(_gaps(local), _unsafe(local)) if local else None
    return tuple(
        Check(
            neighbours=n,
            foretold=_foretold(world, n),
            at_gaps=float(by_gap(_gaps(rows)).mean()) if by_gap else None,
            seen=wilson(int(_unsafe(rows).sum()), len(rows)),
        )
        for n, rows in sorted(town.items())
    )


def _gaps(rows: Sequence[Row]) -> FloatArray:
    """Return the gap between bumpers on the target lane (n,), inf where nobody is there [m]."""
    gaps = (row["scores"]["gap"] for row in rows)
    return np.array([math.inf if gap is None else gap for gap in gaps])


def _unsafe(rows: Sequence[Row]) -> Truth:
    return np.array([row["unsafe"] for row in rows], dtype=np.bool_)


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
    columns = (
        "neighbours",
        "merges",
        "foretold",
        "at the same gaps",
        "seen in the town",
        "within the interval",
        "off by",
    )
    rows = tuple(
        (
            str(check.neighbours),
            str(check.seen.n),
            _share(check.foretold),
            _share(check.at_gaps),
            interval(check.seen, 3),
            NOTHING if check.holds is None else "yes" if check.holds else "no",
            NOTHING if check.off is None else f"{check.off:+.3f}",
        )
        for check in found
    )
    near = f"within {REACH:g} m before and behind the ego, on its own lane or beside it"
    notes = (
        f"Shares of unsafe merges, by neighbours: {near}.",
        "At the same gaps: what local merges foretell for the gaps on the target lane that the town's had (isotonic).",
    )
    return Table("What the learned worlds foretell, and the town", columns, rows, notes)


def _share(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.3f}"
