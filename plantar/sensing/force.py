"""Forces of a sole: centre of pressure and ground reaction wrench."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames, taxel_values
from plantar.sensing.activation import active_taxels

__all__ = ["center_of_pressure", "ground_reaction_wrench"]


def center_of_pressure(
    layout: SoleLayout, force: ArrayLike, threshold: float | None = None
) -> NDArray[np.float64] | None:
    """Centre of pressure of one sole (T 4.21).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) in N; taxels that are dead, saturated or not active are left out.
        threshold: Activation threshold in N; that of the layout where None.

    Returns:
        Position (2,) in the sole frame in m, or None where the sole carries no force. For many frames see
        `plantar.batch.loads`.

    Raises:
        ReadingError: If these are not n numbers.
        InputError: If the threshold is NaN or no number.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> center_of_pressure(layout, np.zeros(len(layout))) is None
        True
    """
    vertical = _active(layout, taxel_values(layout, force), threshold) * layout.rotations[:, 2, 2]
    total = float(vertical.sum())
    if not total > 0.0:
        return None
    return np.asarray(vertical @ layout.positions[:, :2] / total)


def ground_reaction_wrench(layout: SoleLayout, force: ArrayLike, threshold: float | None = None) -> NDArray[np.float64]:
    """Ground reaction wrench at the sole frame's origin (T 4.23).

    Args:
        layout: The sole, n taxels.
        force: Normal forces (n,) or (frames, n) in N; taxels that are dead, saturated or not active are left out.
        threshold: Activation threshold in N; that of the layout where None.

    Returns:
        Wrench (6,) or (frames, 6) in the sole frame in N and N m, exerted by the world on the sole.

    Raises:
        ReadingError: If these are not n numbers a frame.
        InputError: If the threshold is NaN or no number.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.1, 0.1))
        >>> ground_reaction_wrench(layout, np.array([10.0, 20.0])).round(9).tolist()
        [0.0, 0.0, 30.0, 1.5, -3.5, 0.0]
    """
    return np.asarray(_active(layout, taxel_frames(layout, force), threshold) @ layout.wrench_map.T)


def _active(layout: SoleLayout, force: NDArray[np.float64], threshold: float | None) -> NDArray[np.float64]:
    """Forces of the active taxels, 0 elsewhere: what `Percept` and `plantar.batch` count, too."""
    low = layout.force_threshold if threshold is None else threshold
    return np.where(active_taxels(force, low, layout.force_limit), force, 0.0)
