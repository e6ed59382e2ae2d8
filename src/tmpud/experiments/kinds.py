"""The kinds of experiments: how the records in a results folder become trials, and trials a report."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tmpud.errors import RunFileError
from tmpud.experiments.reports.analysis import Analysis, analyse, report
from tmpud.experiments.reports.document import Picture, Report
from tmpud.experiments.running.store import Results, provenance, read_results
from tmpud.experiments.running.tasks import Record, results_hash
from tmpud.experiments.statistics.paper_numbers import FIGURE4, TABLE1, Reference
from tmpud.experiments.statistics.rows import TrialRow
from tmpud.experiments.trials.figure4 import Figure4
from tmpud.experiments.trials.figure4 import deviations as figure4_deviations
from tmpud.experiments.trials.grid import Cell, Grid, cells
from tmpud.experiments.trials.grid import rows as grid_rows
from tmpud.experiments.trials.table1 import CARLA_DEVIATIONS
from tmpud.experiments.trials.table1 import DEVIATIONS as TABLE1_DEVIATIONS

if TYPE_CHECKING:
    from tmpud.experiments.reports.charts import Panel

RESAMPLING_SEED = 1
Rows = Callable[[Mapping[str, Any], Iterable[Record]], Iterable[TrialRow]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What tells one kind of experiment from another once its tasks are done."""

    title: str
    rows: Rows  # of the manifest's options and the records
    reference: Reference
    cells: Callable[[Mapping[str, Any]], list[Cell]] | None = None  # of the options, where it was driven in traffic
    batches: bool = False  # whether bars show the spread over batches, as in the paper's figure
    deviations: Callable[[Iterable[Record]], Sequence[str]] = lambda _: ()


def _of_grid(options: Mapping[str, Any], records: Iterable[Record]) -> Iterable[TrialRow]:
    return grid_rows(Grid.from_json(options), records)


def _cells(options: Mapping[str, Any]) -> list[Cell]:
    return cells(Grid.from_json(options))


def _of_figure(options: Mapping[str, Any], records: Iterable[Record]) -> Iterable[TrialRow]:
    return Figure4.from_json(options).rows(records)


KINDS = {
    "table1": Kind(
        title="Full simulation: Table I",
        rows=_of_grid,
        cells=_cells,
        reference=TABLE1,
        deviations=lambda _: TABLE1_DEVIATIONS,
    ),
    "table1-carla": Kind(
        title="Full simulation on a CARLA server: Table I",
        rows=_of_grid,
        cells=_cells,
        reference=TABLE1,
        deviations=lambda _: CARLA_DEVIATIONS,
    ),
    "figure4": Kind(
        title="Abstract simulation: the paper's figure",
        rows=_of_figure,
        reference=FIGURE4,
        batches=True,
        deviations=figure4_deviations,
    ),
    "sweep": Kind(title="A sweep in full simulation", rows=_of_grid, cells=_cells, reference={}),
    "sweep-carla": Kind(title="A sweep on a CARLA server", rows=_of_grid, cells=_cells, reference={}),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Findings:
    """All that a results folder says."""

    kind: Kind
    results: Results
    rows: tuple[TrialRow, ...]
    analysis: Analysis

    @property
    def hash(self) -> str:
        return results_hash(self.results.records)

    def to_json(self) -> dict[str, Any]:
        done = {"results_hash": self.hash, "done": len(self.results.records), "complete": self.results.complete}
        return {**done, **self.analysis.to_json()}

    def report(self) -> Report:
        """Return the report; nothing of it depends on when it is written."""
        manifest = self.results.manifest
        return report(
            self.analysis,
            title=self.kind.title,
            command=manifest["command"],
            run=provenance(self.results),
            pictures=(self.picture(),),
            deviations=self.kind.deviations(self.results.records),
        )

    def _repr_html_(self) -> str:
        """Return the tables and the picture for a notebook."""
        from tmpud.experiments.reports.document import render

        return render("sections.html", self.report())

    @property
    def bars(self) -> str:
        """What the bars of a picture show."""
        return "one standard deviation over the batches" if self.kind.batches else "95 % intervals"

    def panels(self) -> tuple[Panel, ...]:
        """Return mean distance against unsafe trials, a panel per condition, points in the order of the cells."""
        from tmpud.experiments.reports.charts import batch_panels, interval_panels

        return batch_panels(self.analysis.pairs) if self.kind.batches else interval_panels(self.analysis.cells)

    def picture(self) -> Picture:
        """Draw the panels."""
        from tmpud.experiments.reports.charts import draw

        caption = f"Distance against unsafe trials; bars: {self.bars}."
        return draw(self.panels(), self.kind.reference, "figure", caption)


def read_findings(folder: str | Path) -> Findings:
    """Return what an experiment's folder says; raises RunFileError."""
    return findings(read_results(Path(folder)))


def findings(results: Results) -> Findings:
    """Return what a results folder says; RunFileError where its experiment is not one of trials."""
    name = results.manifest["experiment"]
    if name not in KINDS:
        raise RunFileError(f"{name!r} is no experiment of trials; these are {', '.join(KINDS)}")
    rows = tuple(KINDS[name].rows(results.manifest["options"], results.records))
    analysis = analyse(rows, KINDS[name].reference, np.random.default_rng(RESAMPLING_SEED))
    return Findings(kind=KINDS[name], results=results, rows=rows, analysis=analysis)
