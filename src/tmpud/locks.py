"""A file that one process at a time holds, until it lets go or ends, however that ends."""

from __future__ import annotations

import fcntl
import os
import time
from pathlib import Path
from typing import IO


class HeldError(Exception):
    """Another process holds the lock; the message is its id."""


def held(file: Path, patience: float) -> IO[str]:
    """Return the lock, which closing lets go; HeldError where another keeps it for longer than ``patience`` s."""
    lock = file.open("a+", encoding="utf-8")
    until = time.monotonic() + patience
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            break
        except BlockingIOError:
            if time.monotonic() < until:
                time.sleep(0.05)
                continue
            lock.seek(0)
            owner = lock.read().strip() or "unknown"
            lock.close()
            raise HeldError(owner) from None
    lock.truncate(0)
    lock.write(f"{os.getpid()}\n")
    lock.flush()
    return lock
