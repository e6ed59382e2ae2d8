"""One trial as a row of a table: what statistics, tables and pictures are made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialRow:
    """How one algorithm fared in one trial; rows with the same condition and trial are paired."""

    condition: str  # such as "normal" or "high density, low acceleration"
    algorithm: str  # such as "tmpud", "no-com" or "threshold(0.3)"
    trial: int
    batch: int = 0
    status: str  # SUCCESS, COLLISION, ... or a tool fault, which counts neither as safe nor as unsafe
    distance: float  # [m] driven
    unsafe: bool  # at least one collision of a merge or one forced stop
    details: Mapping[str, Any] = field(default_factory=dict)  # whatever else was measured

    @property
    def arrived(self) -> bool:
        return self.status == "SUCCESS"
