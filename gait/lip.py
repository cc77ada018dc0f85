"""Linear inverted pendulum (T 4.1)."""

from __future__ import annotations

import math

from plantar.errors import InputError

__all__ = ["GRAVITY", "pendulum_frequency"]

GRAVITY = 9.81
"""Standard gravity in m/s^2."""


def pendulum_frequency(com_height: float) -> float:
    """Natural frequency omega = sqrt(g / z_x) of the pendulum (T 4.1).

    Args:
        com_height: Height of the CoM above the ground in m, above 0.

    Returns:
        Frequency in rad/s.

    Raises:
        InputError: If the height is not a positive finite number.

    Example:
        >>> round(pendulum_frequency(0.8), 4)
        3.5018
    """
    if not (math.isfinite(com_height) and com_height > 0.0):
        raise InputError(f"CoM height is {com_height} m; allowed: a finite value above 0")
    return math.sqrt(GRAVITY / com_height)
