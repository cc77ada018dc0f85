"""Support polygon of one or two feet in a common frame."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.kernels import convex as _kernel
from plantar.polygon import convex_hull

__all__ = ["feet_support_polygon", "polygon_in_world"]


def polygon_in_world(
    polygon_in_sole: NDArray[np.float64],
    rotation_sole_to_world: NDArray[np.float64],
    position_sole_in_world: NDArray[np.float64],
) -> NDArray[np.float64]:
    """A polygon of the sole plane, seen from above in the world frame.

    Args:
        polygon_in_sole: Polygon (k, 2) in the sole frame in m.
        rotation_sole_to_world: Rotation (3, 3).
        position_sole_in_world: Position (3,) of the sole frame's origin in m.

    Returns:
        Polygon (k, 2) in m in the world's x-y plane.

    Example:
        >>> polygon_in_world(np.array([[1.0, 0.0]]), np.eye(3), np.array([0.0, 2.0, 5.0])).tolist()
        [[1.0, 2.0]]
    """
    seen: NDArray[np.float64] = _kernel.seen_from_above(
        np.asarray(polygon_in_sole, dtype=float),
        np.asarray(rotation_sole_to_world, dtype=float),
        np.asarray(position_sole_in_world, dtype=float),
    )
    return seen


def feet_support_polygon(polygons_in_world: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Convex support polygon of all feet (T 4.25).

    Args:
        polygons_in_world: Support polygon (k, 2) of each foot in the world frame; empty for a foot in the air.

    Returns:
        Convex polygon (m, 2), counter-clockwise, empty where no foot has contact.

    Example:
        >>> left = np.array([[0.0, 0.1], [0.2, 0.1], [0.2, 0.2], [0.0, 0.2]])
        >>> feet_support_polygon([left, left * [1, -1]]).tolist()
        [[0.0, -0.2], [0.2, -0.2], [0.2, 0.2], [0.0, 0.2]]
    """
    parts = [p for p in polygons_in_world if len(p)]
    return convex_hull(np.concatenate(parts) if len(parts) != 1 else parts[0]) if parts else np.empty((0, 2))
