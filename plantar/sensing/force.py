"""Forces of a sole: centre of pressure and ground reaction wrench.

A wrench is [fx, fy, fz, tx, ty, tz] in N and N m, exerted BY the world ON the robot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames, taxel_values, without_dead

__all__ = ["center_of_pressure", "ground_reaction_wrench"]


def center_of_pressure(layout: SoleLayout, force: ArrayLike) -> NDArray[np.float64] | None:
    """Centre of pressure of one sole (T 4.21).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) in N, 0 for the taxels to leave out; dead ones, NaN or inf, are left out too.

    Returns:
        Position (2,) in the sole frame in m, or None where the sole carries no force. For many frames see
        `plantar.batch.loads`.

    Raises:
        ReadingError: If these are not n numbers.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> center_of_pressure(layout, np.zeros(len(layout))) is None
        True
    """
    vertical = without_dead(taxel_values(layout, force)) * layout.rotations[:, 2, 2]
    total = float(vertical.sum())
    if not total > 0.0:
        return None
    return np.asarray(vertical @ layout.positions[:, :2] / total)


def ground_reaction_wrench(layout: SoleLayout, force: ArrayLike) -> NDArray[np.float64]:
    """Ground reaction wrench at the sole frame's origin (T 4.23).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) or (frames, n) in N, 0 for the taxels to leave out; dead ones, NaN or inf, are left
            out too.

    Returns:
        Wrench (6,) or (frames, 6) in the sole frame in N and N m, exerted by the world on the sole.

    Raises:
        ReadingError: If these are not n numbers a frame.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.1, 0.1))
        >>> ground_reaction_wrench(layout, np.array([10.0, 20.0])).round(9).tolist()
        [0.0, 0.0, 30.0, 1.5, -3.5, 0.0]
    """
    return np.asarray(without_dead(taxel_frames(layout, force)) @ layout.wrench_map.T)
