"""What was made last from folders that may change."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

K = TypeVar("K", bound=Hashable)  # what names it: a folder, or several
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class _Made(Generic[T]):
    what: T
    stamp: Hashable  # of what it was made from
    begun: float  # monotonic clock


class Kept(Generic[K, T]):
    """Makes one thing at a time; all who asked before it was begun get the same."""

    def __init__(self, most: int, make: Callable[[K], Awaitable[T]], stamp: Callable[[K], Hashable]) -> None:
        self._most, self._make, self._stamp = most, make, stamp
        self._made: dict[K, _Made[T]] = {}
        self._making = asyncio.Lock()

    async def of(self, name: K) -> T:
        """Return what belongs to a name as it is now; raises what making it raises."""
        asked = time.monotonic()
        async with self._making:
            stamp, known = self._stamp(name), self._made.pop(name, None)
            if known is None or (known.stamp != stamp and known.begun < asked):
                begun = time.monotonic()
                known = _Made(await self._make(name), stamp, begun)
            self._made[name] = known  # now the last
            while len(self._made) > self._most:
                del self._made[next(iter(self._made))]
            return known.what
