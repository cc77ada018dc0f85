"""The one way from a polygon to the kernels of the shapes in and around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.kernels import is_compiled
from plantar.kernels.geometry.shapes import ConvexShapes
from plantar.plane_points import plane_points

__all__ = ["convex_shapes", "points_of"]

_SHARED = ConvexShapes(False) if is_compiled("shapes") else None


def convex_shapes() -> ConvexShapes:
    """The kernels with their work arrays.

    Returns:
        Those that all calls share where they are compiled and so follow each other, else some of one's own.

    Example:
        >>> convex_shapes().triangle(points_of([[0, 0], [1, 0], [0, 1]])).tolist()
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    """
    return _SHARED if _SHARED is not None else ConvexShapes(True)


def points_of(points: ArrayLike) -> NDArray[np.float64]:
    """Points as an array of float64; those that are not finite are for the kernels to leave out.

    Args:
        points: Points (k, 2) in m, or an empty list.

    Returns:
        Points (k, 2) in m; not copied where they are one.

    Raises:
        InputError: If these are not (k, 2) real numbers.

    Example:
        >>> points_of([]).shape, points_of([[1, 2]]).tolist()
        ((0, 2), [[1.0, 2.0]])
    """
    return plane_points(points, finite=False)
