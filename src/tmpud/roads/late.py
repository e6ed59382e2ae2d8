"""Lanes and connections of a large map, made of their rows when they are first asked for, a block at a time."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import eq
from typing import Any, TypeVar, overload

BLOCK = 1_000  # [rows]; all blocks but the last have so many

Row = list[Any]
Block = list[Row] | bytes  # rows, or a line of JSON that holds their kind and them
T = TypeVar("T")


def rows_of(block: Block) -> list[Row]:
    rows: list[Row] = json.loads(block)[1] if isinstance(block, bytes) else block
    return rows


class Late(Sequence[T]):
    """Rows, or JSON of them, that become objects."""

    def __init__(self, blocks: Sequence[Block], count: int, make: Callable[..., T]) -> None:
        self._blocks, self._count, self._make = list(blocks), count, make
        self._made: list[list[T]] = [[] for _ in blocks]

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, place: int) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[T]: ...
    def __getitem__(self, place: int | slice) -> T | Sequence[T]:
        if isinstance(place, slice):
            return [self[i] for i in range(*place.indices(self._count))]
        number, at = divmod(range(self._count)[place], BLOCK)
        return (self._made[number] or self._block(number))[at]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sequence):
            return NotImplemented
        return len(self) == len(other) and all(map(eq, self, other))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return repr(tuple(self))

    def _block(self, number: int) -> list[T]:
        block = self._blocks[number]
        if block:  # else another thread has just made it
            self._made[number] = [self._make(*row) for row in rows_of(block)]
            self._blocks[number] = []
        return self._made[number]


class Named(Mapping[str, T]):
    """Objects by their names, which are known from the start."""

    def __init__(self, names: Sequence[str], items: Late[T]) -> None:
        self._places, self._items = {name: place for place, name in enumerate(names)}, items
        self._made: dict[str, T] = {}  # what was asked for, found in one step

    def __getitem__(self, name: str) -> T:
        made = self._made.get(name)
        if made is None:
            made = self._made[name] = self._items[self._places[name]]
        return made

    def __contains__(self, name: object) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __repr__(self) -> str:
        return repr(dict(self))
