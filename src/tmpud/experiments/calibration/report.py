"""``paper calibration``: its tasks, and the report on what came of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tmpud.experiments.calibration.foresight import Check, check_table
from tmpud.experiments.calibration.predictions import Measured, quality_table
from tmpud.experiments.calibration.scenes import local_tasks, town_tasks
from tmpud.experiments.reports.document import Report, Section
from tmpud.experiments.running.tasks import Task

NOTES = (
    "Unsafe: a collision that the judge lays to the merge, or a forced stop, within 8 s and before the next merge.",
    "Local: merges forced in the small area from which the abstract worlds are learned, four road conditions.",
    "Town: random missions in full simulation; the ego merges at every opportunity, at most once in 8 s.",
    "Every predictor is asked about the very scene in which a merge begins. Merges that nobody saw end are left out.",
    "Gap, time to collision and RSS ratio look at the target lane alone, without the roads before and behind it.",
    "Intervals are at 95 %, by a bootstrap over drives (local merges each by itself).",
)


def calibration_tasks(merges: int, drives: int, first_seed: int, map_: str) -> list[Task]:
    """Return all tasks; either number may be 0."""
    return [*town_tasks(drives, first_seed, map_), *local_tasks(merges, first_seed)]


def calibration_report(
    found: Sequence[Measured], worlds: Sequence[Check], command: str, run: Mapping[str, str]
) -> Report:
    """Return the report on what was measured, and on what the learned worlds foretold; without merges it says so."""
    from tmpud.experiments.calibration.charts import draw_calibration

    tables = [quality_table(merges, qualities) for merges, qualities in found]
    picture = (draw_calibration(found),) if found else ()
    sections = [
        Section(title="What was measured", lines=NOTES if found else ("No merge was begun.",), pictures=picture),
        *(Section(title=table.title, table=table) for table in [*tables, check_table(worlds)]),
    ]
    return Report(title="How well Safe foretells an unsafe merge", command=command, run=run, sections=tuple(sections))
