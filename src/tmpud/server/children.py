"""Work that takes long or much memory, done in a process of its own, such that no page waits for another's."""

from __future__ import annotations

import asyncio
import os
import resource
import sys
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import AsyncGenerator, AsyncIterator, Hashable
from contextlib import asynccontextmanager, suppress
from pathlib import Path

from tmpud.errors import RunFileError
from tmpud.experiments.running.processes import die_with, ending

LIMIT = 600.0  # [s] for one piece of work
MEMORY = 4 << 30  # bytes


@asynccontextmanager
async def child(module: str, *words: str | Path, stderr: int = DEVNULL) -> AsyncIterator[Process]:
    """Run a module of this package; it is killed when what it is needed for ends, however that ends."""
    command = (sys.executable, "-m", module, str(os.getpid()), *words)
    process = await asyncio.create_subprocess_exec(
        *command, stdin=DEVNULL, stdout=PIPE, stderr=stderr, start_new_session=True
    )
    try:
        yield process
    finally:
        with suppress(ProcessLookupError):
            process.kill()
        await process.communicate()  # nothing of it is left


async def heard(module: str, *words: str | Path) -> AsyncGenerator[bytes, None]:
    """Yield the lines that a module writes to stdout; RunFileError where it does not end well."""
    async with child(module, *words) as process:
        if process.stdout is not None:
            async for line in process.stdout:
                yield line
        if code := await process.wait():
            raise RunFileError(f"its process died: {ending(code)}")


async def said_by(module: str, *words: str | Path) -> bytes:
    """Return what a module writes to stdout; RunFileError with its last word on stderr where it fails."""
    async with child(module, *words, stderr=PIPE) as process:
        try:
            out, err = await asyncio.wait_for(process.communicate(), LIMIT)
        except TimeoutError as error:
            raise RunFileError(f"it took more than {LIMIT:.0f} s") from error
    if process.returncode:
        raise RunFileError(err.decode(errors="replace").strip().rpartition("\n")[2] or "too little memory")
    return out


def begin(*, short: bool = False) -> list[str]:
    """Be modest, and end with the server; return the words this process was started with. For a child's ``main``."""
    os.nice(0 if short else 10)  # what is being run goes first
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    die_with(int(sys.argv[1]))
    return sys.argv[2:]


def stamp(*files: Path) -> Hashable:
    """Return what changes whenever one of the files does; RunFileError where one is not there."""
    try:
        found = [file.stat() for file in files]
    except OSError as error:
        raise RunFileError(f"{error.filename}: {error.strerror}") from error
    return tuple((one.st_ino, one.st_size, one.st_mtime_ns) for one in found)
