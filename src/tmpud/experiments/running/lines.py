"""Lines of JSON that show whether they are whole: what a results file is made of."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tmpud.experiments.running.tasks import DONE, Record

LINE = re.compile(rb'\{"sha256":"([0-9a-f]{32})","record":(\{.*\})\}\n')


@dataclass(frozen=True, slots=True)
class Contents:
    """What a results file holds."""

    found: tuple[tuple[int, Record], ...]  # (line, record) of every whole line
    damages: tuple[str, ...]  # "file:line: what", one a damaged line
    size: int  # [bytes] up to the end of the last complete line


def encode(record: Record) -> bytes:
    """Return a record as one line that carries a checksum of its own bytes."""
    row = {"key": record.key, "digest": record.digest, "status": record.status, "result": record.result}
    payload = json.dumps(row, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()
    return b'{"sha256":"%s","record":%s}\n' % (_checksum(payload), payload)


def decode(line: bytes) -> Record:
    """Return the record of a line with its newline; ValueError where any byte of it changed."""
    match = LINE.fullmatch(line)
    if not match:
        raise ValueError("not a line of results")
    if _checksum(match[2]) != match[1]:
        raise ValueError("the checksum does not fit")
    return Record(**json.loads(match[2]))


def read(file: Path) -> Contents:
    """Read a results file; a file that is not there is an empty one."""
    found, damages, size = [], [], 0
    for number, line in enumerate(_lines(file), 1):
        if not line.endswith(b"\n"):
            damages.append(f"{file}:{number}: cut off; dropped")
            break
        size += len(line)
        try:
            found.append((number, decode(line)))
        except (ValueError, TypeError) as error:
            damages.append(f"{file}:{number}: damaged ({error})")
    return Contents(tuple(found), tuple(damages), size)


def counted(
    file: Path, contents: Contents, digests: Mapping[str, str] | None = None
) -> tuple[dict[str, Record], list[str]]:
    """Return the record that counts for each key, and what does not count, each as "file:line: why".

    The first that is DONE counts; where none is, the last: a task that ended in a tool fault may have been tried again.
    ``digests`` tells which task each key stands for; where it is not given, a key's first record does.
    """
    records: dict[str, Record] = {}
    refused = []
    for line, record in contents.found:
        known = records.get(record.key)
        wanted = known.digest if known else record.digest
        if digests is not None:
            wanted = digests.get(record.key, "")
        if record.digest != wanted:
            refused.append(f"{file}:{line}: of another task than the present {record.key!r}; does not count")
        elif known is None or known.status != DONE:
            records[record.key] = record
        elif known != record:
            refused.append(f"{file}:{line}: a second, other result of {record.key!r}; the first counts")
    return records, refused


def _checksum(payload: bytes) -> bytes:
    return hashlib.sha256(payload).hexdigest()[:32].encode()


def _lines(file: Path) -> Iterable[bytes]:
    try:
        with file.open("rb") as lines:
            yield from lines
    except FileNotFoundError:
        return
