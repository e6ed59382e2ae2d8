"""Every error that tmpud raises on purpose. One root, so that callers can catch it."""

from __future__ import annotations


class TmpudError(Exception):
    """Root of all errors of this package; the message is one line fit for a user."""

    exit_code = 2


class _InFileError(TmpudError):
    """Something wrong in a user's file: ``file:line: cause``."""

    def __init__(self, source: str, line: int | None, cause: str) -> None:
        self.source, self.line, self.cause = source, line, cause
        super().__init__(f"{source}:{line}: {cause}" if line is not None else f"{source}: {cause}")


class MapError(_InFileError):
    """A road map that cannot be used."""


class RulesError(_InFileError):
    """A user's rules for plans that are not ASP, or more than rules may be."""


class RequestError(TmpudError):
    """A service request that names something the map does not have."""


class NoPlanError(TmpudError):
    """No sequence of actions reaches the goal; the message says what cuts it off."""

    exit_code = 1


class UtilityOverflowError(TmpudError):
    """A cost too large for the solver's 32-bit integers."""


class InfeasibleMotionError(TmpudError):
    """No path that the vehicle can drive implements the transition."""


class InvalidStateError(TmpudError):
    """A state or command that is not finite or not one the vehicle can have."""


class SimulatorError(TmpudError):
    """The simulator is missing, refused to start, or died."""

    exit_code = 3


class SimulatorHangError(SimulatorError):
    """The simulator does not answer."""


class RunFileError(TmpudError):
    """A run folder or event log that is damaged or of another schema."""

    exit_code = 4


class FolderError(TmpudError):
    """A results folder that is another experiment's, in use, or cannot be written."""
