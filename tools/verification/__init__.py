"""The parts of ``tools/verify.py``: what is checked, how it is shown, where it is kept."""
