"""Results files damaged in every way that disks, editors and people have; none may yield a wrong value."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tmpud.experiments.running import lines
from tmpud.experiments.running.tasks import DONE, Record, digest

Damage = Callable[[bytes, random.Random], bytes]
ROWS = 40


@dataclass(slots=True)
class Tally:
    """What came of damages; the last four are to be 0."""

    cases: int = 0
    damaged_lines: int = 0
    wrong: int = 0  # values that count and are not those that were written
    unnamed: int = 0  # damaged lines that are not named
    misnamed: int = 0  # whole lines that are named as damaged
    dropped: int = 0  # whole lines whose record does not count
    notes: list[str] = field(default_factory=list)


def originals() -> list[Record]:
    return [
        Record(key=f"heavy/{n:04d}", digest=digest(n), status=DONE, result={"distance": 1234.5 + n, "unsafe": n % 7})
        for n in range(ROWS)
    ]


def flip_bits(data: bytes, rng: random.Random) -> bytes:
    return _changed(data, rng, lambda old: old ^ (1 << rng.randrange(8)), rng.choice([1, 1, 3, 20]))


def change_digits(data: bytes, rng: random.Random) -> bytes:
    """Make numbers other numbers: such lines are still JSON."""
    places = [place for place, byte in enumerate(data) if chr(byte).isdecimal()]
    damaged = bytearray(data)
    for place in rng.sample(places, rng.choice([1, 2, 5])):
        damaged[place] = rng.choice(b"0123456789")
    return bytes(damaged)


def overwrite_with_zeros(data: bytes, rng: random.Random) -> bytes:
    start, length = rng.randrange(len(data)), rng.choice([1, 64, 512, 4096])
    return data[:start] + b"\0" * min(length, len(data) - start) + data[start + length :]


def drop_a_span(data: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(data))
    return data[:start] + data[start + rng.choice([1, 5, 100, 1000]) :]


def repeat_a_span(data: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(data))
    return data[: start + rng.choice([1, 5, 100, 1000])] + data[start:]


def insert_bytes(data: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(data) + 1)
    return data[:start] + rng.choice([b"\n", b" ", b"\r", b"{}\n", rng.randbytes(7)]) + data[start:]


def cut_short(data: bytes, rng: random.Random) -> bytes:
    return data[: rng.randrange(len(data))]


def end_lines_as_elsewhere(data: bytes, _: random.Random) -> bytes:
    return data.replace(b"\n", b"\r\n")


def exchange_values(data: bytes, rng: random.Random) -> bytes:
    """Give one line's result to another."""
    rows = data.splitlines(keepends=True)
    one, other = rng.sample(range(len(rows)), 2)
    head, _, _ = rows[one].partition(b'"result"')
    _, middle, tail = rows[other].partition(b'"result"')
    rows[one] = head + middle + tail
    return b"".join(rows)


def move_lines(data: bytes, rng: random.Random) -> bytes:
    rows = data.splitlines(keepends=True)
    rng.shuffle(rows)
    return b"".join(rows + rng.sample(rows, 3))


DAMAGES: tuple[Damage, ...] = (
    flip_bits, change_digits, overwrite_with_zeros, drop_a_span, repeat_a_span, insert_bytes, cut_short,
    end_lines_as_elsewhere, exchange_values, move_lines,
)  # fmt: skip


def damage(number: int, seed: int, folder: Path) -> Tally:
    """Damage a results file in many ways; what is read is compared with the lines that were written."""
    records = originals()
    data = b"".join(map(lines.encode, records))
    tally, rng = Tally(), random.Random(seed)
    for case in range(number):
        how = DAMAGES[case % len(DAMAGES)]
        file = folder / "results.jsonl"
        file.write_bytes(how(data, rng))
        before = len(tally.notes)
        _judge(file, records, tally)
        if len(tally.notes) > before:
            tally.notes[-1] += f" ({how.__name__}, case {case})"
    return tally


def _judge(file: Path, records: list[Record], tally: Tally) -> None:
    known = {lines.encode(record): record for record in records}
    rows = [row + b"\n" for row in file.read_bytes().split(b"\n")]
    rows[-1:] = [rows[-1][:-1]] if rows[-1] != b"\n" else []
    damaged = {number for number, row in enumerate(rows, 1) if row not in known}
    whole = {known[row].key: known[row] for row in rows if row in known}
    contents = lines.read(file)
    counted, refused = lines.counted(file, contents, {record.key: record.digest for record in records})
    named = {int(text.removeprefix(f"{file}:").partition(":")[0]) for text in (*contents.damages, *refused)}
    wrong = sum(record != whole.get(key) for key, record in counted.items())
    unnamed, misnamed, dropped = len(damaged - named), len(named - damaged), len(whole.keys() - counted.keys())
    tally.cases += 1
    tally.damaged_lines += len(damaged)
    tally.wrong, tally.unnamed = tally.wrong + wrong, tally.unnamed + unnamed
    tally.misnamed, tally.dropped = tally.misnamed + misnamed, tally.dropped + dropped
    if wrong or unnamed or misnamed or dropped:
        tally.notes.append(f"{wrong} wrong, {unnamed} unnamed, {misnamed} misnamed, {dropped} dropped")


def _changed(data: bytes, rng: random.Random, change: Callable[[int], int], count: int) -> bytes:
    damaged = bytearray(data)
    for _ in range(count):
        place = rng.randrange(len(damaged))
        damaged[place] = change(damaged[place])
    return bytes(damaged)
