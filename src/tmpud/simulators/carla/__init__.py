"""CARLA: a town on a CARLA server, driven through the real client, which lives in a process of its own.

Here and in ``simulator.py``, ``session.py``, ``lanes.py`` and ``signals.py`` nothing of the client is imported; in
``child.py`` and what it imports, all of it.
"""
