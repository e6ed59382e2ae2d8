"""From a results folder to what people read: cells, claims, tables, pictures, one report."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmpud.experiments.cells import Cell, cells
from tmpud.experiments.claims import Finding, judge
from tmpud.experiments.pairing import Paired, pair
from tmpud.experiments.paper_numbers import ALGORITHMS, FIGURE4, TABLE1, Reference
from tmpud.experiments.report import Picture, Report, Section
from tmpud.experiments.rows import TrialRow
from tmpud.experiments.table import comparison, findings_table, statuses_table, verdicts
from tmpud.experiments.tasks import Record, results_hash

if TYPE_CHECKING:
    from tmpud.experiments.store import Results

RESAMPLING_SEED = 1
Options = Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What tells one kind of experiment from another once its trials have run."""

    title: str
    rows: Callable[[Options, Iterable[Record]], Iterable[TrialRow]]
    reference: Reference
    batches: bool = False  # whether bars show the spread over batches, as the paper's figure does
    deviations: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Analysis:
    """What an experiment's trials say."""

    kind: Kind
    rows: tuple[TrialRow, ...]
    pairs: tuple[Paired, ...]
    cells: tuple[Cell, ...]
    findings: tuple[Finding, ...]

    def to_json(self) -> dict[str, Any]:
        return {
            "cells": [cell.to_json() for cell in self.cells],
            "claims": [finding.to_json() for finding in self.findings],
        }


def kind_of(name: str) -> Kind:
    """Return the kind of experiment that a manifest names."""
    return {"table1": _table1, "sweep": _sweep, "figure4": _figure4}[name]()


def analyse(results: Results) -> Analysis:
    """Return what the records of a results folder say; the resampling has a seed of its own."""
    kind = kind_of(results.manifest["experiment"])
    return analyse_rows(kind, tuple(kind.rows(results.manifest["options"], results.records)))


def analyse_rows(kind: Kind, rows: tuple[TrialRow, ...]) -> Analysis:
    """Return what some trials say."""
    conditions = list(dict.fromkeys(row.condition for row in rows))
    pairs = pair(rows, conditions, ALGORITHMS)
    rng = np.random.default_rng(RESAMPLING_SEED)
    return Analysis(
        kind=kind,
        rows=rows,
        pairs=pairs,
        cells=tuple(cell for paired in pairs for cell in cells(paired, rows, rng)),
        findings=tuple(finding for paired in pairs for finding in judge(paired, rng)),
    )


def report(analysis: Analysis, results: Results) -> Report:
    """Return the report of an experiment; nothing of it depends on when it is written."""
    manifest, kind = results.manifest, analysis.kind
    return Report(
        title=kind.title,
        command=manifest["command"],
        run=_run(manifest, results.records),
        sections=(
            Section(title="Result", pictures=(picture(analysis),), table=_table(analysis)),
            Section(
                title="The paper's claims", lines=verdicts(analysis.findings), table=findings_table(analysis.findings)
            ),
            *_sections(kind.deviations, results.damages),
            Section(title="How the trials ended", table=statuses_table(analysis.cells)),
        ),
    )


def picture(analysis: Analysis) -> Picture:
    """Draw mean distance against unsafe trials, a panel per condition."""
    from tmpud.experiments.charts import batch_panels, draw, interval_panels

    panels = batch_panels(analysis.pairs) if analysis.kind.batches else interval_panels(analysis.cells)
    bars = "one standard deviation over batches" if analysis.kind.batches else "95 % intervals"
    return draw(panels, analysis.kind.reference, "figure", f"Distance against unsafe trials; bars: {bars}.")


def _table(analysis: Analysis) -> Any:
    return comparison("Distance and unsafe behaviour", analysis.cells, analysis.kind.reference)


def _run(manifest: Mapping[str, Any], records: Sequence[Record]) -> dict[str, str]:
    return {
        "begun": manifest["begun"],
        **{f"option {name}": str(value) for name, value in manifest["options"].items()},
        "versions": ", ".join(f"{name} {version}" for name, version in manifest["versions"].items()),
        "code": manifest["code"],
        "tasks": f"{manifest['tasks']['count']} (digest {manifest['tasks']['digest']}), {len(records)} done",
        "results": results_hash(records),
    }


def _sections(deviations: tuple[str, ...], damages: tuple[str, ...]) -> Iterable[Section]:
    if deviations:
        yield Section(title="What differs from the paper, and why", lines=deviations)
    if damages:
        yield Section(title="Damaged lines, which were left out", lines=damages)


def _table1() -> Kind:
    from tmpud.experiments import table1

    return Kind(
        title="Full simulation: the paper's Table I", rows=_grid_rows, reference=TABLE1, deviations=table1.DEVIATIONS
    )


def _sweep() -> Kind:
    return Kind(title="Sweep in full simulation", rows=_grid_rows, reference={})


def _figure4() -> Kind:
    from tmpud.experiments import figure4

    return Kind(
        title="Abstract simulation: the paper's figure",
        rows=figure4.rows,
        reference=FIGURE4,
        batches=True,
        deviations=figure4.DEVIATIONS,
    )


def _grid_rows(options: Options, records: Iterable[Record]) -> Iterable[TrialRow]:
    from tmpud.experiments.grid import Grid, rows

    return rows(Grid.from_json(options), records)
