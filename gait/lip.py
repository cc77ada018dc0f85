"""Linear inverted pendulum and divergent component of motion (T 4.1, 4.9-4.12)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError

__all__ = ["GRAVITY", "dcm", "pendulum_frequency"]

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


def dcm(com: ArrayLike, com_velocity: ArrayLike, omega: float) -> NDArray[np.float64]:
    """Divergent component of motion xi = x + x' / omega (T 4.9).

    Args:
        com: CoM position (..., d) in m.
        com_velocity: CoM velocity (..., d) in m/s.
        omega: Pendulum frequency in rad/s.

    Returns:
        DCM (..., d) in m.

    Example:
        >>> dcm([0.0, 0.1], [0.35, 0.0], 3.5).tolist()
        [0.09999999999999999, 0.1]
    """
    return np.asarray(com, dtype=float) + np.asarray(com_velocity, dtype=float) / omega
