"""``python -m tmpud.cli``."""

from tmpud.cli import main

main()
