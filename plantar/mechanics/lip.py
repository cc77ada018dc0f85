"""Linear inverted pendulum and its divergent component of motion, DCM (T 4.1)."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import positive
from plantar.common.arrays import is_finite, numbers
from plantar.common.gravity import GRAVITY
from plantar.errors import InputError

__all__ = ["GRAVITY", "divergent_component", "pendulum_frequency"]


def pendulum_frequency(com_height: float, legs: float = 0.0) -> float:
    """Natural frequency omega = sqrt(g / z_x) of the pendulum (T 4.1).

    Args:
        com_height: Height of CoM above ground in m, above 0.
        legs: 2 D in s^2 of legs that turn with it (`plantar.gait.plan.leg_momentum`): omega = (z_x / g + 2 D)^(-1/2).

    Returns:
        Frequency in rad/s.

    Raises:
        InputError: Height not finite.
    """
    return math.sqrt(GRAVITY / (positive(com_height, "CoM height", "m") + GRAVITY * legs))


def divergent_component(com: ArrayLike, com_velocity: ArrayLike, omega: float) -> NDArray[np.float64]:
    """DCM xi = x + x' / omega of the CoM (T 4.9, T 4.27).

    Args:
        com: CoM position (..., d) in m.
        com_velocity: CoM velocity (..., d) in m/s.
        omega: Pendulum frequency sqrt(g / z) in rad/s, above 0.

    Returns:
        DCM (..., d) in m.

    Raises:
        InputError: Frequency not above 0.

    Example:
        >>> divergent_component([0.0, 0.1], [0.5, 0.0], 4.0).tolist()
        [0.125, 0.1]
    """
    rate = positive(omega, "pendulum frequency", "rad/s")
    position = numbers(com, "CoM")
    velocity = numbers(com_velocity, "velocity of the CoM")
    if position.shape != velocity.shape:
        raise InputError(f"CoM has shape {position.shape}, its velocity {velocity.shape}; expected the same")
    if is_finite(velocity):
        return position + velocity / rate
    with np.errstate(over="ignore", invalid="ignore"):
        return position + velocity / rate
