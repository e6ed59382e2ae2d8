"""From rows to what is shown of them: pairs, cells, findings, and the report of a comparison with the paper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmpud.experiments.reports.document import Picture, Report, Section
from tmpud.experiments.reports.table import Table, comparison, findings_table, statuses_table, verdicts
from tmpud.experiments.statistics.cells import Cell, cells
from tmpud.experiments.statistics.claims import Finding, judge
from tmpud.experiments.statistics.intervals import RESAMPLES
from tmpud.experiments.statistics.pairing import Paired, pair
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, Reference
from tmpud.experiments.statistics.rows import TrialRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """What an experiment's trials say, beside the paper's numbers."""

    reference: Reference
    pairs: tuple[Paired, ...]  # one per condition
    cells: tuple[Cell, ...]
    findings: tuple[Finding, ...]

    def table(self, title: str) -> Table:
        return comparison(title, self.cells, self.reference)

    def to_json(self) -> dict[str, Any]:
        return {
            "cells": [{**cell.to_json(), "paper": self._paper(cell)} for cell in self.cells],
            "claims": [finding.to_json() for finding in self.findings],
            "verdicts": list(verdicts(self.findings)),
        }

    def _paper(self, cell: Cell) -> dict[str, float] | None:
        paper = self.reference.get(cell.condition, {}).get(cell.algorithm)
        return {"distance": paper.distance, "per_1000": paper.per_1000} if paper else None


def analyse(
    rows: Iterable[TrialRow], reference: Reference, rng: np.random.Generator, resamples: int = RESAMPLES
) -> Analysis:
    """Analyse trials; a generator of the same seed gives the same intervals, whatever order the rows come in."""
    table = list(rows)
    pairs = pair(table, tuple(reference), ALGORITHMS)
    return Analysis(
        reference=reference,
        pairs=pairs,
        cells=tuple(cell for paired in pairs for cell in cells(paired, table, rng, resamples)),
        findings=tuple(finding for paired in pairs for finding in judge(paired, rng, resamples)),
    )


def report(
    analysis: Analysis,
    *,
    title: str,
    command: str,
    run: Mapping[str, str],
    pictures: Sequence[Picture] = (),
    deviations: Sequence[str] = (),
) -> Report:
    """Return the report of a comparison; ``deviations`` says where the experiment departs from the paper, and why."""
    results, claims, statuses = (
        analysis.table("Results"),
        findings_table(analysis.findings),
        statuses_table(analysis.cells),
    )
    sections = [
        Section(title="Verdicts", lines=verdicts(analysis.findings)),
        Section(title=results.title, table=results, pictures=tuple(pictures)),
        Section(title=claims.title, table=claims),
        Section(title="Deviations from the paper", lines=tuple(deviations)),
        Section(title=statuses.title, table=statuses),
    ]
    shown = (s for s in sections if s.lines or (s.table and s.table.rows))
    return Report(title=title, command=command, run=run, sections=tuple(shown))
