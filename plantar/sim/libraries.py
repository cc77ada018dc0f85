"""Which libraries every module of the simulator needs; they are its extra, and nothing is loaded here."""

from __future__ import annotations

__all__ = ["LIBRARIES"]

LIBRARIES = ("mujoco", "scipy", "daqp")
"""Names of the modules as they are imported."""
