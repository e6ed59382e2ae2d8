"""Safe and efficient urban driving by task-motion planning (TMPUD, IROS 2020)."""

__version__ = "0.1.0"
