"""Forces of a sole: centre of pressure and ground reaction wrench.

A wrench is [fx, fy, fz, tx, ty, tz] in N and N m, exerted BY the world ON the robot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.layout import SoleLayout

__all__ = ["center_of_pressure", "ground_reaction_wrench", "wrench_at", "zmp_of_feet", "zmp_of_wrench"]


def center_of_pressure(layout: SoleLayout, force: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Centre of pressure of one sole (T 4.21).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) in N, 0 for the taxels to leave out.

    Returns:
        Position (2,) in the sole frame in m, or None where the sole carries no force.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> center_of_pressure(layout, np.zeros(len(layout))) is None
        True
    """
    vertical = layout.rotations[:, 2, 2] * force
    total = float(vertical.sum())
    if not total > 0.0:
        return None
    return np.asarray(vertical @ layout.positions[:, :2] / total)


def ground_reaction_wrench(layout: SoleLayout, force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ground reaction wrench at the sole frame's origin (T 4.23).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) or (frames, n) in N, 0 for the taxels to leave out.

    Returns:
        Wrench (6,) or (frames, 6) in the sole frame in N and N m, exerted by the world on the sole.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.1, 0.1))
        >>> ground_reaction_wrench(layout, np.array([10.0, 20.0])).round(9).tolist()
        [0.0, 0.0, 30.0, 1.5, -3.5, 0.0]
    """
    return np.asarray(force @ layout.wrench_map.T)


def wrench_at(wrench: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same wrench with its moment taken about another point.

    Args:
        wrench: Wrench (..., 6) about the frame's origin.
        point: New reference point (3,) in the same frame in m.

    Returns:
        Wrench (..., 6) about `point`: tau_p = tau_o - p x f.

    Example:
        >>> wrench_at(np.array([0.0, 0.0, 10.0, 0.0, -2.0, 0.0]), np.array([0.2, 0.0, 0.0])).tolist()
        [0.0, 0.0, 10.0, 0.0, 0.0, 0.0]
    """
    out = np.array(wrench, dtype=float)
    out[..., 3:] -= np.cross(point, out[..., :3])
    return out


def zmp_of_wrench(wrench: NDArray[np.float64], minimum_force: float = 1.0) -> NDArray[np.float64] | None:
    """Zero moment point of one wrench in the plane z = 0 of its frame (T 4.5-4.6 for a force-torque sensor).

    Args:
        wrench: Wrench (6,) about the frame's origin.
        minimum_force: Vertical force in N below which there is no ZMP.

    Returns:
        Position (2,) in m, or None.

    Example:
        >>> zmp_of_wrench(np.array([0, 0, 100.0, 5.0, -2.0, 0])).tolist()
        [0.02, 0.05]
    """
    if not wrench[2] >= minimum_force:
        return None
    return np.array([-wrench[4] / wrench[2], wrench[3] / wrench[2]])


def zmp_of_feet(points: list[NDArray[np.float64] | None], vertical_forces: list[float]) -> NDArray[np.float64] | None:
    """Composite ZMP of the feet (T 4.7-4.8).

    Args:
        points: ZMP (2,) of each foot in a common frame in m, None for a foot without load.
        vertical_forces: Vertical force of each foot in N.

    Returns:
        Position (2,) in the common frame in m, or None where no foot carries load.

    Example:
        >>> zmp_of_feet([np.array([0.0, 0.1]), np.array([0.0, -0.1])], [300.0, 100.0]).tolist()
        [0.0, 0.05]
    """
    total = 0.0
    moment = np.zeros(2)
    for point, force in zip(points, vertical_forces, strict=True):
        if point is not None and force > 0.0:
            total += force
            moment += force * point
    return moment / total if total > 0.0 else None
