"""OpenDRIVE maps (``.xodr``) as CARLA's own parser understands them, read in a child process (``reading``)."""
