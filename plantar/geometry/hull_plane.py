"""The largest plane of a convex hull, on which it could rest."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library

# Of a sole's own slopes: Open Duck Mini's have 2 and 3 degrees, its chamfers 31 and 38. With planes within 1 degree the
# soles of 40 other public models are the same.
_ROUNDED = np.cos(np.radians(5.0))


def hull_plane(
    points: NDArray[np.float64], highest: float, same: float, faces: int
) -> tuple[NDArray[np.float64], float]:
    """Largest plane of the convex hull of points (n, 3).

    With planes that are off by up to 5 degrees it is the largest: a rounded sole is larger than the chamfer beside it.
    Returns outward normal (3,) and area; straight down and 0 without one.

    Example:
        >>> corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], dtype=float)
        >>> hull_plane(corners, -0.9, 0.99, 12)
        (array([ 0.,  0., -1.]), 2.0)
    """
    with optional_library("scipy", "shoes"):
        from scipy.spatial import ConvexHull, QhullError
    down = np.array([0.0, 0.0, -1.0])
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return down, 0.0
    corners = points[hull.simplices]
    normal = hull.equations[:, :3]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    area[normal[:, 2] > highest] = 0.0
    largest = np.argsort(-area, kind="stable")[:faces]
    along = [normal @ normal[i] for i in largest]
    around = max(along, key=lambda cosine: float(area[cosine > _ROUNDED].sum())) > _ROUNDED
    planes = [cosine > same for cosine, i in zip(along, largest, strict=True) if around[i]]
    best = max(planes, key=lambda plane: float(area[plane].sum()))
    if not area[best].any():
        return down, 0.0
    mean = (area[best, None] * normal[best]).sum(axis=0)
    return mean / np.linalg.norm(mean), float(area[best].sum())
