"""Wrenches of any patch of skin from its force and proximity signals together: on the body (K) and on the hands (A).

Skin cells are given by their positions and rotations in the frame the wrench is wanted in: a link, a patch, or the CoM.
A cell's z axis points into the body, so what it feels pushes along +z. K 4-5 print [0, 0, -f], which is the same push
written for a z axis that points out of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError, ReadingError

__all__ = ["active_cells", "patch_signal", "pseudo_force", "skin_wrench"]


def active_cells(
    force: ArrayLike, proximity: ArrayLike, force_threshold: float, proximity_threshold: float
) -> NDArray[np.bool_]:
    """Cells that feel force OR see something near (K 2 corrected).

    Printed is AND, with which a cell that is about to be touched, force still 0, could never be active.

    Args:
        force: Force signals (..., n), in N or normalised.
        proximity: Proximity signals (..., n), growing as something comes near.
        force_threshold: epsilon_force in the unit of `force`.
        proximity_threshold: epsilon_prox in the unit of `proximity`.

    Returns:
        Mask (..., n); a cell whose signals are both NaN or inf is not active.

    Example:
        >>> active_cells([0.0, 0.4, 0.0, np.nan], [0.8, 0.9, 0.0, np.nan], 0.1, 0.1).tolist()
        [True, True, False, False]
    """
    f, p = np.asarray(force, dtype=np.float64), np.asarray(proximity, dtype=np.float64)
    return np.asarray(((f > force_threshold) & (f < np.inf)) | ((p > proximity_threshold) & (p < np.inf)))


def pseudo_force(
    force: ArrayLike,
    proximity: ArrayLike,
    force_weight: float,
    proximity_weight: float,
    active: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Pseudo-force f = w_force v_force + w_prox v_prox of each cell (K 3).

    Args:
        force: Force signals (..., n).
        proximity: Proximity signals (..., n), growing as something comes near.
        force_weight: w_force, in N per unit of `force`.
        proximity_weight: w_prox, in N per unit of `proximity`.
        active: Mask (..., n), for example of `active_cells`; all cells where None.

    Returns:
        Pseudo-forces (..., n) in N, 0 for cells that are not active; a signal that is NaN or inf counts as 0.

    Example:
        >>> pseudo_force([0.0, 0.5, np.nan], [0.2, 1.0, 0.5], 10.0, 2.0).tolist()
        [0.4, 7.0, 1.0]
    """
    total = force_weight * _finite(force) + proximity_weight * _finite(proximity)
    return np.asarray(total if active is None else np.where(np.asarray(active, dtype=bool), total, 0.0))


def patch_signal(force: ArrayLike, proximity: ArrayLike, weight: float) -> NDArray[np.float64]:
    """Weighted sum F = w f + (1 - w) p of each cell (A 6).

    Args:
        force: Force signals (..., n), normalised to 0..1.
        proximity: Proximity signals (..., n), normalised to 0..1, 1 at contact.
        weight: w: 0 reacts to proximity alone, 1 to force alone.

    Returns:
        Signals (..., n); a signal that is NaN or inf counts as 0.

    Raises:
        InputError: If the weight is not within 0 to 1.

    Example:
        >>> patch_signal([0.0, 1.0], [0.5, 1.0], 0.25).tolist()
        [0.375, 1.0]
    """
    if not 0.0 <= weight <= 1.0:
        raise InputError(f"weight of force against proximity is {weight}; allowed: 0 to 1")
    return weight * _finite(force) + (1.0 - weight) * _finite(proximity)


def skin_wrench(positions: ArrayLike, rotations: ArrayLike, signal: ArrayLike) -> NDArray[np.float64]:
    """Wrench of normal forces on skin cells: sum_i [R_i f_i, p_i x R_i f_i] (K 4-5, A 7-8, T 3.16-3.18).

    Args:
        positions: Cell positions (n, 3) in the wanted frame in m; with K, relative to the CoM.
        rotations: Rotations (n, 3, 3) from each cell's frame to the wanted frame.
        signal: Normal forces (n,) or (frames, n) in N, of `pseudo_force`, `patch_signal` or a reading; NaN or inf
            counts as 0.

    Returns:
        Wrench (6,) or (frames, 6) about the wanted frame's origin in N and N m, exerted by the world on the robot.

    Raises:
        ReadingError: If the shapes do not agree.

    Example:
        >>> skin_wrench([[0.0, 0.1, 0.5]], [np.eye(3)], [10.0]).tolist()
        [0.0, 0.0, 10.0, 1.0, 0.0, 0.0]
    """
    r, turn, f = np.asarray(positions, dtype=float), np.asarray(rotations, dtype=float), _finite(signal)
    if r.ndim != 2 or r.shape[1] != 3 or turn.shape != (len(r), 3, 3) or f.shape[-1:] != (len(r),):
        raise ReadingError(
            f"cells have positions {r.shape}, rotations {turn.shape} and signals {f.shape}; "
            "expected (n, 3), (n, 3, 3) and (..., n)"
        )
    normal = turn[:, :, 2]
    return np.asarray(f @ np.hstack([normal, np.cross(r, normal)]))


def _finite(signal: ArrayLike) -> NDArray[np.float64]:
    return np.nan_to_num(np.asarray(signal, dtype=np.float64), nan=0.0, posinf=0.0, neginf=0.0)
