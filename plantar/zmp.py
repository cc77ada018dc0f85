"""Points of the ground that tell balance: zero moment point, centroidal moment pivot, divergent component of motion.

A wrench is [fx, fy, fz, tx, ty, tz] in N and N m about the frame's origin, exerted BY the world ON the robot, z up.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError

__all__ = ["centroidal_moment_pivot", "divergent_component", "zero_moment_wrench", "zmp_in_plane"]


def zmp_in_plane(wrench: ArrayLike, height: float = 0.0, minimum_force: float = 1.0) -> NDArray[np.float64] | None:
    """Zero moment point of a wrench in a plane z = height (T 4.5-4.6).

    There the wrench has no moment about x and y: p = [(h fx - ty) / fz, (h fy + tx) / fz].

    Args:
        wrench: Wrench (6,) about the frame's origin.
        height: Height h of the plane above the frame's origin in m.
        minimum_force: Vertical force in N below which there is no ZMP.

    Returns:
        Position (2,) in m, or None where the vertical force is below `minimum_force` or not above 0, or NaN.

    Example:
        >>> zmp_in_plane([10.0, 0.0, 100.0, 5.0, -2.0, 0.0], height=0.1).tolist()
        [0.03, 0.05]
    """
    point = _zero_moment_point(np.asarray(wrench, dtype=float).tolist(), height, minimum_force)
    return None if point is None else np.array(point)


def _zero_moment_point(wrench: list[float], height: float, minimum_force: float) -> tuple[float, float] | None:
    """`zmp_in_plane` in plain numbers."""
    fx, fy, fz, tx, ty, _ = wrench
    if not (fz >= minimum_force and 0.0 < fz < math.inf):
        return None
    x, y = (height * fx - ty) / fz, (height * fy + tx) / fz
    return (x, y) if math.isfinite(x) and math.isfinite(y) else None


def zero_moment_wrench(
    wrench: ArrayLike, height: float = 0.0, minimum_force: float = 1.0
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """The ground reaction force with zero moment: the wrench transferred to its ZMP (T 4.2.4, after 4.23).

    Args:
        wrench: Wrench (6,) about the frame's origin.
        height: Height of the plane of the ZMP in m.
        minimum_force: Vertical force in N below which there is no ZMP.

    Returns:
        The point (3,) in m and the wrench (6,) about it: the same force, moments 0 about x and y, and the twist about
        z that is left; None without load.

    Example:
        >>> point, moved = zero_moment_wrench([10.0, 0.0, 100.0, 5.0, -2.0, 0.3])
        >>> point.tolist(), moved.tolist()
        ([0.02, 0.05, 0.0], [10.0, 0.0, 100.0, 0.0, 0.0, 0.8])
    """
    given: list[float] = np.asarray(wrench, dtype=float).tolist()
    at = _zero_moment_point(given, height, minimum_force)
    if at is None:
        return None
    x, y = at
    fx, fy, fz, _, _, tz = given
    return np.array([x, y, height]), np.array([fx, fy, fz, 0.0, 0.0, tz - (x * fy - y * fx)])


def centroidal_moment_pivot(
    force: ArrayLike, com: ArrayLike, height: float = 0.0, minimum_force: float = 1.0
) -> NDArray[np.float64] | None:
    """Centroidal moment pivot: where the line of the ground reaction force, put through the CoM, meets the ground.

    It coincides with the ZMP where the wrench has no moment about the CoM that tips the robot (Popovic, Goswami and
    Herr 2005), one of the metrics of balance that T names beside ZMP, GRF and DCM.

    Args:
        force: Ground reaction force (3,) or wrench (6,) of all feet in N.
        com: CoM position (3,) in m.
        height: Height of the ground in m.
        minimum_force: Vertical force in N below which there is none.

    Returns:
        Position (2,) in m, or None without load.

    Example:
        >>> centroidal_moment_pivot([50.0, 0.0, 500.0], [0.0, 0.1, 0.8]).round(9).tolist()
        [-0.08, 0.1]
    """
    fx, fy, fz = np.asarray(force, dtype=float)[:3].tolist()
    x, y, z = np.asarray(com, dtype=float).tolist()
    if not (fz >= minimum_force and 0.0 < fz < math.inf):
        return None
    pivot = (x - fx / fz * (z - height), y - fy / fz * (z - height))
    return np.array(pivot) if math.isfinite(pivot[0]) and math.isfinite(pivot[1]) else None


def divergent_component(com: ArrayLike, com_velocity: ArrayLike, omega: float) -> NDArray[np.float64]:
    """Divergent component of motion xi = x + x' / omega of the CoM (T 4.9, T 4.27).

    Args:
        com: CoM position (..., d) in m.
        com_velocity: CoM velocity (..., d) in m/s.
        omega: Pendulum frequency sqrt(g / z) in rad/s, above 0.

    Returns:
        DCM (..., d) in m.

    Raises:
        InputError: If omega is not a finite value above 0.

    Example:
        >>> divergent_component([0.0, 0.1], [0.5, 0.0], 4.0).tolist()
        [0.125, 0.1]
    """
    if not 0.0 < omega < math.inf:
        raise InputError(f"pendulum frequency is {omega} rad/s; allowed: a finite value above 0")
    return np.asarray(com, dtype=float) + np.asarray(com_velocity, dtype=float) / omega
