"""How well Safe foretells an unsafe merge, and the learned worlds the full simulation."""
