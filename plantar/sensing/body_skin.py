"""Wrenches of a skin patch from force and proximity: on the body (K) and hands (A).

Cells are in the frame of the wrench. A cell's force pushes along its +z, into the body (K 4-5 print [0, 0, -f] for an
axis out of it).
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number
from plantar.common.arrays import array, mask, numbers
from plantar.errors import InputError, ReadingError
from plantar.layouts.taxel_values import without_dead


def active_cells(
    force: ArrayLike, proximity: ArrayLike, force_threshold: float, proximity_threshold: float
) -> NDArray[np.bool_]:
    """Mask (..., n) of cells with force OR proximity above a threshold (K 2 corrected; printed AND).

    `force`: force signals (..., n), in N or normalised; `proximity`: proximity signals (..., n), larger when nearer;
    `force_threshold`: epsilon_force in unit of `force`; `proximity_threshold` likewise.

    Returns mask; NaN, inf or beyond `LARGEST` does not count; errors if shapes differ.
    """
    f, p = _signals(force, proximity)
    least_force = number(force_threshold, "threshold of force")
    least_proximity = number(proximity_threshold, "threshold of proximity")
    return np.asarray(((f > least_force) & (f <= LARGEST)) | ((p > least_proximity) & (p <= LARGEST)))


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
        proximity: Proximity signals (..., n), larger when nearer.
        force_weight: w_force, in N per unit of `force`.
        proximity_weight: w_prox, in N per unit of `proximity`.
        active: Mask (..., n), e.g. of `active_cells`; all cells if None.

    Returns pseudo-forces (..., n) in N, 0 for inactive cells and NaN, inf or beyond `LARGEST`; errors if shapes differ.
    """
    f, p = _signals(force, proximity)
    by_force = number(force_weight, "weight of force", finite=True)
    by_proximity = number(proximity_weight, "weight of proximity", finite=True)
    total = np.asarray(by_force * without_dead(f) + by_proximity * without_dead(p))
    return total if active is None else np.where(mask(active, "mask 'active'", f.shape, ReadingError), total, 0.0)


def patch_signal(force: ArrayLike, proximity: ArrayLike, weight: float) -> NDArray[np.float64]:
    """Weighted sum F = w f + (1 - w) p of each cell (A 6).

    `force`: force signals (..., n), normalised to 0..1; `proximity`: proximity signals (..., n), normalised to 0..1, 1
    at contact; `weight`: w: 0 for proximity alone, 1 for force alone.

    Returns signals (..., n); NaN, inf or beyond `LARGEST` counts as 0; errors if shapes differ.
    """
    f, p = _signals(force, proximity)
    share = number(weight, "weight of force against proximity", nan=True)
    if not 0.0 <= share <= 1.0:
        raise InputError(f"weight of force against proximity is {weight}; allowed: 0 to 1")
    return share * without_dead(f) + (1.0 - share) * without_dead(p)


def skin_wrench(positions: ArrayLike, rotations: ArrayLike, signal: ArrayLike) -> NDArray[np.float64]:
    """Wrench of normal forces on skin cells: sum_i [R_i f_i, p_i x R_i f_i] (K 4-5, A 7-8, T 3.16-3.18).

    `positions`: cell positions (n, 3) in wanted frame in m; with K, relative to CoM; `rotations`: rotations (n, 3, 3)
    from each cell's frame to wanted frame; `signal`: normal forces (n,) or (frames, n) in N; NaN, inf or beyond
    `LARGEST` counts as 0.

    Returns wrench (6,) or (frames, 6) about wanted frame's origin in N and N m, by world on robot; ReadingError:
    shapes do not agree.
    """
    r = numbers(positions, "positions of cells", ReadingError)
    turn = numbers(rotations, "rotations of cells", ReadingError)
    f = numbers(signal, "signals of cells", ReadingError)
    # nature: points of space
    if r.ndim != 2 or r.shape[1] != 3 or turn.shape != (len(r), 3, 3) or f.ndim not in (1, 2) or f.shape[-1] != len(r):
        raise ReadingError(
            f"cells have positions {r.shape}, rotations {turn.shape} and signals {f.shape}; "
            "expected (n, 3), (n, 3, 3) and (n,) or (frames, n)"
        )
    array(r, "positions of cells", (...,), ReadingError, finite=True)
    normal = array(turn, "rotations of cells", (...,), ReadingError, finite=True)[:, :, 2]
    return np.asarray(without_dead(f) @ np.hstack([normal, np.cross(r, normal)]))


def _signals(force: ArrayLike, proximity: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    f = numbers(force, "force signals", ReadingError)
    p = numbers(proximity, "proximity signals", ReadingError)
    if f.shape != p.shape:
        raise ReadingError(f"force signals have shape {f.shape}, proximity signals {p.shape}; expected the same")
    return f, p
