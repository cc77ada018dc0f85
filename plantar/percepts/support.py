"""Support polygon of one or two feet in a common frame."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arguments import items
from plantar.arrays import array
from plantar.geometry.polygon import convex_hull
from plantar.kernels.geometry import convex as _kernel
from plantar.plane_points import plane_points

__all__ = ["feet_support_polygon", "polygon_in_world"]


def polygon_in_world(
    polygon_in_sole: ArrayLike,
    rotation_sole_to_world: ArrayLike,
    position_sole_in_world: ArrayLike,
) -> NDArray[np.float64]:
    """A polygon of the sole plane, seen from above in the world frame.

    Args:
        polygon_in_sole: Polygon (k, 2) in the sole frame in m.
        rotation_sole_to_world: Rotation (3, 3).
        position_sole_in_world: Position (3,) of the sole frame's origin in m.

    Returns:
        Polygon (k, 2) in m in the world's x-y plane.

    Raises:
        InputError: If a shape is wrong, or a value not finite.

    Example:
        >>> polygon_in_world(np.array([[1.0, 0.0]]), np.eye(3), np.array([0.0, 2.0, 5.0])).tolist()
        [[1.0, 2.0]]
    """
    seen: NDArray[np.float64] = _kernel.seen_from_above(
        plane_points(polygon_in_sole),
        array(rotation_sole_to_world, "rotation", (3, 3), finite=True),
        array(position_sole_in_world, "position", (3,), finite=True),
    )
    return seen


def feet_support_polygon(polygons_in_world: Sequence[ArrayLike]) -> NDArray[np.float64]:
    """Convex support polygon of all feet (T 4.25).

    Args:
        polygons_in_world: Support polygon (k, 2) of each foot in the world frame; empty for a foot in the air.

    Returns:
        Convex polygon (m, 2), counter-clockwise, empty where no foot has contact.

    Raises:
        InputError: If a polygon is not (k, 2) finite numbers.

    Example:
        >>> left = np.array([[0.0, 0.1], [0.2, 0.1], [0.2, 0.2], [0.0, 0.2]])
        >>> feet_support_polygon([left, left * [1, -1]]).tolist()
        [[0.0, -0.2], [0.2, -0.2], [0.2, 0.2], [0.0, 0.2]]
    """
    parts = [p for p in map(plane_points, items(polygons_in_world, "polygons")) if len(p)]
    return convex_hull(np.concatenate(parts) if len(parts) != 1 else parts[0]) if parts else np.empty((0, 2))
