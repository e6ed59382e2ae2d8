"""The abstract simulation's world models, and how they are learned."""
