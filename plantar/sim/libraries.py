"""The simulator's libraries, which are its extra; none is loaded here."""

from __future__ import annotations

__all__ = ["LIBRARIES"]

LIBRARIES = ("mujoco", "scipy", "daqp")
"""Names of the modules as they are imported."""
