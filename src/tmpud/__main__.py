"""``python -m tmpud`` is the command ``tmpud``."""

from tmpud.cli import main

if __name__ == "__main__":
    main()
