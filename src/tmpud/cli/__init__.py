"""The command line. Every command imports what it needs when it runs, so that ``--help`` is quick."""

from __future__ import annotations

import sys
from typing import Annotated, NoReturn

import typer

import tmpud
from tmpud.cli import carla, checking, driving, experiments, exporting, planning, viewing
from tmpud.errors import TmpudError

INTERRUPTED = 130
EXIT_CODES = {
    0: "done",
    1: "no plan leads there, or the drive did not arrive",
    2: "what was asked cannot be done: an option, a map, a place, a file, a folder",
    3: "the simulator does not start, or died",
    4: "a run or results folder cannot be read",
    INTERRUPTED: "interrupted; what was recorded is kept",
}

app = typer.Typer(
    help="Safe and efficient urban driving by task-motion planning (TMPUD).",
    epilog="\b\nExit codes:\n" + "\n".join(f"  {code:<5}{meaning}" for code, meaning in EXIT_CODES.items()),
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
for part in (driving, planning, experiments, viewing, exporting, checking, carla):
    app.add_typer(part.app)


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"tmpud {tmpud.__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line; a user's error is one line on stderr."""
    debug = "--debug" in sys.argv
    if debug:
        sys.argv.remove("--debug")
    try:
        code = app(standalone_mode=False) or 0
        if code == INTERRUPTED:
            _fail("", INTERRUPTED)
        sys.exit(code)
    except KeyboardInterrupt:
        _fail("", INTERRUPTED)
    except Exception as error:
        if debug or not (code := _exit_code(error)):
            raise
        if type(error).__name__ == "NoArgsIsHelpError":
            error.show()  # type: ignore[attr-defined]
            sys.exit(code)
        _fail(_message(error), code)


def _exit_code(error: Exception) -> int:
    """Return the exit code for an error of the user's, 0 for any other."""
    if isinstance(error, TmpudError):
        return error.exit_code
    if type(error).__name__ == "Abort":
        return INTERRUPTED
    return 2 if isinstance(error, OSError) or hasattr(error, "format_message") else 0


def _message(error: Exception) -> str:
    """Return an error in one line: of the system's, which file and what about it."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return error.format_message() if hasattr(error, "format_message") else str(error)


def _fail(message: str, code: int) -> NoReturn:
    typer.echo(f"tmpud: {message or EXIT_CODES[INTERRUPTED]}", err=True)
    sys.exit(code)
