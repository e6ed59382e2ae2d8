"""Trials as files for other tools: CSV, JSON, Parquet."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tmpud.errors import RequestError
from tmpud.experiments.statistics.rows import TrialRow

FIELDS = ("condition", "algorithm", "trial", "batch", "status", "distance", "unsafe")


def write_rows(rows: Sequence[TrialRow], file: Path) -> None:
    """Write trials in the format that the file's name ends in; RequestError for another."""
    write = FORMATS.get(file.suffix)
    if write is None:
        raise RequestError(f"{file}: trials can be written as {', '.join(FORMATS)}")
    write(flat(rows), file)


def flat(rows: Sequence[TrialRow]) -> list[dict[str, Any]]:
    """Return a mapping per trial, all with the same keys; what is not a single value is JSON text."""
    names = list(dict.fromkeys(name for row in rows for name in row.details))
    return [
        {name: getattr(row, name) for name in FIELDS} | {name: _single(row.details.get(name)) for name in names}
        for row in rows
    ]


def _single(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, dict | list | tuple) else value


def _csv(rows: list[dict[str, Any]], file: Path) -> None:
    with file.open("w", encoding="utf-8", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(rows[0] if rows else FIELDS)
        writer.writerows(row.values() for row in rows)


def _json(rows: list[dict[str, Any]], file: Path) -> None:
    file.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def _parquet(rows: list[dict[str, Any]], file: Path) -> None:
    try:
        import polars
    except ImportError as error:
        raise RequestError('Parquet needs polars: pip install "tmpud[parquet]"') from error
    polars.DataFrame(rows, infer_schema_length=None).write_parquet(file)


FORMATS: dict[str, Callable[[list[dict[str, Any]], Path], None]] = {".csv": _csv, ".json": _json, ".parquet": _parquet}
