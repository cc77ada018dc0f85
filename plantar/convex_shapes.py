"""The one way from a polygon to the kernels of the shapes in and around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.kernels import is_compiled
from plantar.kernels.shapes import ConvexShapes

__all__ = ["convex_shapes", "points_of"]

_SHARED = ConvexShapes(False) if is_compiled("shapes") else None


def convex_shapes() -> ConvexShapes:
    """The kernels with their work arrays: shared where compiled calls follow each other, else one of its own."""
    return _SHARED if _SHARED is not None else ConvexShapes(True)


def points_of(points: ArrayLike) -> NDArray[np.float64]:
    """Points as an array (k, 2) of float64; an empty list has no points.

    Example:
        >>> points_of([]).shape, points_of([[1, 2]]).tolist()
        ((0, 2), [[1.0, 2.0]])
    """
    array = np.asarray(points, dtype=np.float64)
    return array if array.ndim == 2 and array.shape[1] == 2 else array.reshape(-1, 2)
