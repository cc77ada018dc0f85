"""The replaceable silicone pad under the taxels: a flat sheet of the contact face's outline. Lengths in mm."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shoes.outline import ring

__all__ = ["pad_surface"]


def pad_surface(outline: Any, thickness: float) -> NDArray[np.float64]:
    """Surface of the pad, its lower face at z = 0.

    Args:
        outline: Outline of the contact face, a shapely polygon in mm.
        thickness: Thickness in mm, above 0.

    Returns:
        Closed surface (n, 3, 3) in mm, outward counter-clockwise.

    Example:
        >>> import shapely
        >>> len(pad_surface(shapely.box(0, 0, 10, 10), 2.0))
        12
    """
    import shapely

    caps = []
    for triangle in shapely.constrained_delaunay_triangles(outline).geoms:
        caps.append(ring(shapely.geometry.polygon.orient(triangle)))
    flat = np.array(caps)
    corners = ring(outline)
    after = np.roll(corners, -1, axis=0)

    def at(points: NDArray[np.float64], z: float) -> NDArray[np.float64]:
        return np.concatenate([points, np.full((*points.shape[:-1], 1), z)], axis=-1)

    sides = [
        np.stack([at(corners, 0.0), at(after, 0.0), at(after, thickness)], axis=1),
        np.stack([at(corners, 0.0), at(after, thickness), at(corners, thickness)], axis=1),
    ]
    return np.concatenate([at(flat, thickness), at(flat, 0.0)[:, ::-1], *sides])
