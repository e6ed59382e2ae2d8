"""A run as an animation, for a README or a talk: ``film.py`` is where to begin."""
