"""Rows as comma-separated values, for whatever reads tables."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import Any

from tmpud.experiments.rows import TrialRow

FIELDS = tuple(f.name for f in fields(TrialRow) if f.name != "details")


def write_csv(rows: Iterable[TrialRow], file: Path) -> None:
    """Write a line per row: its fields, then a column "details.NAME" for each detail that any row has.

    Truth values, None, lists and mappings are written as JSON, text and numbers as they are.
    """
    table = list(rows)
    details = sorted({name for row in table for name in row.details})
    with file.open("w", newline="", encoding="utf-8", errors="replace") as out:
        writer = csv.writer(out)
        writer.writerow([*FIELDS, *(f"details.{name}" for name in details)])
        for row in table:
            values = [getattr(row, name) for name in FIELDS] + [row.details.get(name, "") for name in details]
            writer.writerow([_plain(value) for value in values])


def _plain(value: Any) -> Any:
    return value if isinstance(value, str | float) or type(value) is int else json.dumps(value)
