"""The simulator's libraries, which are its extra; none is loaded here."""

__all__ = ["LIBRARIES"]

LIBRARIES = ("mujoco", "scipy", "daqp")
"""Names of the modules as they are imported."""
