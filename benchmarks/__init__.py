"""Measurements of speed, each against what it could cost at least; run as modules."""
