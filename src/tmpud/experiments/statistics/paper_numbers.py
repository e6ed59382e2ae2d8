"""What the paper reports: its Table I, and the points of its abstract-simulation figure.

The figure's numbers are read off the published plot by eye, to about 0.5 m and 1 unsafe behaviour per 1,000 trials.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

ALGORITHMS = ("tmpud", "threshold(0.5)", "threshold(0.3)", "threshold(0.1)", "no-com")  # the table's order
LABELS = {
    "tmpud": "TMPUD",
    "threshold(0.5)": "Th(0.5)",
    "threshold(0.3)": "Th(0.3)",
    "threshold(0.1)": "Th(0.1)",
    "no-com": "No-com",
}


@dataclass(frozen=True, slots=True)
class PaperCell:
    """One algorithm's result in one condition."""

    distance: float  # [m] mean
    unsafe: int  # collisions and stops
    trials: int

    @property
    def per_1000(self) -> float:
        return 1000 * self.unsafe / self.trials


Reference = Mapping[str, Mapping[str, PaperCell]]  # condition -> algorithm -> cell; the keys are in the paper's order


def _condition(trials: int, *cells: tuple[float, int]) -> dict[str, PaperCell]:
    return {name: PaperCell(*cell, trials) for name, cell in zip(ALGORITHMS, cells, strict=True)}


TABLE1: Reference = {
    "normal": _condition(200, (514, 0), (537, 0), (513, 5), (478, 24), (426, 48)),
    "heavy": _condition(200, (530, 2), (545, 2), (528, 7), (497, 35), (426, 54)),
}

FIGURE4: Reference = {
    "low density, low acceleration": _condition(1000, (447, 46), (510, 48), (452, 52), (429, 57), (426, 69)),
    "low density, high acceleration": _condition(1000, (446, 58), (509, 58), (452, 59), (429, 71), (426, 81)),
    "high density, low acceleration": _condition(1000, (445, 64), (509, 64), (451, 67), (430, 87), (426, 97)),
    "high density, high acceleration": _condition(1000, (446, 72), (510, 68), (451, 82), (430, 98), (426, 116)),
}
