"""CoM admittance: the CoM reference yields to ZMP error (T 4.29)."""

from __future__ import annotations

from plantar.kernels.gait.dcm_feedback import ComAdmittance

__all__ = ["LARGEST_OFFSET", "ComAdmittance"]

LARGEST_OFFSET = 0.5
"""Length in legs that a balance law lets the CoM's reference be off its plan: no foot reaches both from there."""
