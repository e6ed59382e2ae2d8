"""Tables as plain data, ours and the paper's numbers side by side, and as text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from tmpud.experiments.running.tasks import TOOL_FAULTS, digest
from tmpud.experiments.statistics.cells import Cell
from tmpud.experiments.statistics.claims import PARTS, Finding, worst
from tmpud.experiments.statistics.intervals import Estimate
from tmpud.experiments.statistics.paper_numbers import LABELS, Reference

NOTHING = "-"  # where there is no number


@dataclass(frozen=True, slots=True)
class Table:
    """What a report, a page or a terminal shows; every cell is text and may be hostile."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    anchors: tuple[str, ...] = ()  # of the rows, where pictures lead to them


def anchor(condition: str, algorithm: str) -> str:
    """Return what the row of a cell is called on a page."""
    return f"cell-{digest([condition, algorithm])}"


def comparison(title: str, cells: Sequence[Cell], reference: Reference) -> Table:
    """Return the paper's table with our cells beside its numbers; intervals are at 95 %."""
    columns = ("", "algorithm", "distance [m]", "paper", "unsafe trials", "per 1,000", "paper", "events", "arrived")
    rows = []
    for cell in cells:
        paper = reference.get(cell.condition, {}).get(cell.algorithm)
        rows.append(
            (
                cell.condition,
                LABELS.get(cell.algorithm, cell.algorithm),
                interval(cell.distance),
                f"{paper.distance:g}" if paper else NOTHING,
                f"{cell.unsafe} of {cell.trials - cell.faults}",
                interval(cell.per_1000),
                f"{paper.per_1000:g}" if paper else NOTHING,
                _counts(cell.events),
                _arrived(cell),
            )
        )
    anchors = tuple(anchor(cell.condition, cell.algorithm) for cell in cells)
    return Table(title, columns, tuple(rows), tuple(_notes(cells)), anchors)


def findings_table(findings: Sequence[Finding]) -> Table:
    """Return each claim's difference, interval and verdict."""
    columns = ("part", "condition", "claim", "difference", "claimed", "trials", "McNemar p", "verdict")
    rows = []
    for finding in findings:
        claim = finding.claim
        unit = "m" if claim.measure == "distance" else "per 1,000"
        difference = f"{interval(finding.difference)} {unit}"
        side = f"{'at most' if claim.equal else 'below'} {claim.bound:g}"
        p_value = NOTHING if finding.p_value is None else f"{finding.p_value:.2g}"
        what = f"{claim.text} ({LABELS.get(claim.first, claim.first)} - {LABELS.get(claim.second, claim.second)})"
        n = str(finding.difference.n)
        rows.append((claim.part, finding.condition, what, difference, side, n, p_value, str(finding.verdict)))
    notes = (
        "holds: the whole 95 % interval is as claimed. consistent: the estimate is, the interval reaches beyond.",
        "not seen: the estimate is not as claimed, the interval reaches there. refuted: the whole interval is not.",
        "Differences are paired: of the same trials. Each interval stands alone; none is adjusted for their number.",
        "Intervals: BCa bootstrap over trials; of unsafe trials at least as wide as Tango's score interval.",
    )
    return Table("Claims", columns, tuple(rows), notes)


def verdicts(findings: Sequence[Finding]) -> tuple[str, ...]:
    """Return a line per part of the claim and condition: the verdict on its weakest sub-claim."""
    conditions = list(dict.fromkeys(finding.condition for finding in findings))
    return tuple(
        f"({part}) {PARTS[part]} - {condition}: {worst(f for f in findings if (f.claim.part, f.condition) == key)}"
        for part in PARTS
        for condition in conditions
        if (key := (part, condition)) in {(f.claim.part, f.condition) for f in findings}
    )


def statuses_table(cells: Sequence[Cell]) -> Table:
    """Return how the trials ended."""
    names = sorted({status for cell in cells for status in cell.statuses}, key=lambda name: (name in TOOL_FAULTS, name))
    columns = ("", "algorithm", "trials", *(f"{name} (tool fault)" if name in TOOL_FAULTS else name for name in names))
    rows = tuple(
        (
            cell.condition,
            LABELS.get(cell.algorithm, cell.algorithm),
            str(cell.trials),
            *(str(cell.statuses.get(name, 0)) for name in names),
        )
        for cell in cells
    )
    return Table("How the trials ended", columns, rows, ("Tool faults count neither as safe nor as unsafe.",))


def interval(estimate: Estimate, decimals: int = 1) -> str:
    """Return "value [low, high]", with more decimals for a value that would look like 0; "?" for an unknown end."""
    if math.isnan(estimate.value):
        return NOTHING
    if estimate.value and not round(estimate.value, decimals):
        decimals -= math.floor(math.log10(abs(estimate.value)) + decimals)
    value, low, high = (
        f"{round(x, decimals) + 0.0:.{decimals}f}" if math.isfinite(x) else "?"  # + 0.0: no minus before a zero
        for x in (estimate.value, estimate.low, estimate.high)
    )
    return f"{value} [{low}, {high}]"


def as_text(table: Table) -> str:
    """Return a table for a terminal; a condition is named once, control characters are left out."""
    lines = [[_printable(cell) for cell in line] for line in (table.columns, *without_repeats(table.rows))]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    body = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines]
    body.insert(1, "  ".join("-" * width for width in widths))
    notes = ["", *map(_printable, table.notes)] if table.notes else []
    return "\n".join([_printable(table.title), "", *body, *notes])


def _printable(text: str) -> str:
    return "".join(letter for letter in text if letter.isprintable())


def without_repeats(rows: Iterable[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Return rows whose first cell is empty where it is the same as above."""
    shown, last = [], None
    for first, *others in rows:
        shown.append(("" if first == last else first, *others))
        last = first
    return shown


def _counts(events: Mapping[str, int]) -> str:
    return ", ".join(f"{n} {kind}" for kind, n in events.items()) or NOTHING


def _arrived(cell: Cell) -> str:
    return f"{cell.arrived} ({cell.own_distance:.1f} m)" if cell.arrived else "0"


def _notes(cells: Sequence[Cell]) -> Iterable[str]:
    yield "In brackets: 95 % intervals. Distances are means over the trials in which all compared algorithms arrived:"
    compared = {cell.condition: cell.distance.n for cell in cells}
    trials = {condition: max(cell.trials for cell in cells if cell.condition == condition) for condition in compared}
    yield "; ".join(f"{condition}: {n} of {trials[condition]}" for condition, n in compared.items()) + "."
    yield "arrived: this algorithm's own arrivals, with the mean distance over them."
    faults = {f"{c.condition}, {c.algorithm}": c.faults for c in cells if c.faults}
    if faults:
        named = "; ".join(f"{name}: {n}" for name, n in faults.items())
        yield f"Tool faults, which count neither as safe nor as unsafe: {named}."
