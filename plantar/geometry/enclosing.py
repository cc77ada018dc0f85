"""Shapes around points: bounding box, oriented box and parallelogram of least area (T 4.2.5).

Polygons may turn either way and repeat vertices; corners (4, 2) in m, counter-clockwise, none (0, 2) for an empty one.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.plane_points import plane_points
from plantar.kernels import compiled
from plantar.kernels.geometry.shapes import ConvexShapes


def bounding_box(points: ArrayLike) -> NDArray[np.float64]:
    """Corners (4, 2) in m of the axis-aligned box of points (k, 2), from the lower left one; (0, 2) without points (T
    4.4.4).

    Example:
        >>> bounding_box([[0.0, 0.0], [2.0, 1.0], [1.0, 3.0]]).tolist()
        [[0.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 3.0]]
        >>> bounding_box([]).shape
        (0, 2)
    """
    return np.asarray(convex_shapes().bounding_box(plane_points(points, "points")))


def oriented_box(polygon: ArrayLike) -> NDArray[np.float64]:
    """Corners (4, 2) in m of the least rectangle around a convex polygon (k, 2), along an edge, exact to 1e-12.

    Example:
        >>> oriented_box([[0.0, 0.0], [1.0, 1.0], [0.0, 2.0], [-1.0, 1.0]]).shape
        (4, 2)
    """
    return np.asarray(convex_shapes().box(plane_points(polygon)))


def enclosing_parallelogram(polygon: ArrayLike) -> NDArray[np.float64]:
    """Corners (4, 2) in m of least parallelogram around a convex polygon (k, 2) (T 4.2.5, [175]), exact to 1e-12."""
    return np.asarray(convex_shapes().parallelogram_around(plane_points(polygon)))


_SHARED = ConvexShapes(False) if compiled else None


def convex_shapes() -> ConvexShapes:
    """Kernels with work arrays: shared if compiled, else new ones."""
    return _SHARED if _SHARED is not None else ConvexShapes(True)
