"""The simulator's libraries, which are its extra; none is loaded here."""

LIBRARIES = ("mujoco", "scipy", "daqp")
"""Names of the modules as they are imported."""
