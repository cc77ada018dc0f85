"""The one way from a polygon to the kernels of the shapes in and around it."""

from __future__ import annotations

from plantar.kernels import is_compiled
from plantar.kernels.geometry.shapes import ConvexShapes

__all__ = ["convex_shapes"]

_SHARED = ConvexShapes(False) if is_compiled("shapes") else None


def convex_shapes() -> ConvexShapes:
    """The kernels with their work arrays.

    Returns:
        Those that all calls share where they are compiled and so follow each other, else some of one's own.

    Example:
        >>> import numpy as np
        >>> convex_shapes().triangle(np.array([[0.0, 0], [1, 0], [0, 1]])).tolist()
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    """
    return _SHARED if _SHARED is not None else ConvexShapes(True)
