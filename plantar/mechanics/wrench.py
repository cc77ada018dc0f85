"""Wrenches [fx, fy, fz, tx, ty, tz] in N and N m about their frame's origin, BY the world ON the robot."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array


def wrench_at(wrench: ArrayLike, point: ArrayLike) -> NDArray[np.float64]:
    """Same wrench (..., 6) about another point: tau_p = tau_o - p x f.

    `wrench`: wrench (..., 6) about frame's origin; NaN or inf give such moments; `point`: new reference point (3,) in
    the same frame in m.

    Example:
        >>> wrench_at(np.array([0.0, 0.0, 10.0, 0.0, -2.0, 0.0]), np.array([0.2, 0.0, 0.0])).tolist()
        [0.0, 0.0, 10.0, 0.0, 0.0, 0.0]
    """
    out = array(wrench, "wrench", (..., 6)).copy()
    px, py, pz = array(point, "point", (3,), finite=True).tolist()
    fx = out[..., 0]
    fy = out[..., 1]
    fz = out[..., 2]
    with np.errstate(over="ignore", invalid="ignore"):  # of forces that are not finite
        out[..., 3] -= py * fz - pz * fy
        out[..., 4] -= pz * fx - px * fz
        out[..., 5] -= px * fy - py * fx
    return out


def wrench_in_frame(
    wrench: ArrayLike, rotation: NDArray[np.float64], position: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Wrench of frame a about frame b's origin, in b's axes: [R f, R tau + p x R f] (E of T 3.21).

    `wrench`: wrench (..., 6) about origin of a; `rotation`: rotation R (3, 3) from a to b; `position`: origin p (3,) of
    a in b in m. Returns wrench (..., 6) about origin of b.
    """
    given = np.asarray(wrench, dtype=float)
    force = given[..., :3] @ rotation.T
    moment = given[..., 3:] @ rotation.T
    return np.concatenate([force, moment + np.cross(position, force)], axis=-1)
