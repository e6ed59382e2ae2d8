"""A server on this machine alone that shows runs and experiments, also while they are written. It only reads."""
