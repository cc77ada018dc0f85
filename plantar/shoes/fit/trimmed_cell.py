"""A cell of which the edge of a region leaves a part. Lengths in mm."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

__all__ = ["trimmed_cell"]

_SHORT = 1.2  # mm: shortest edge that is left


def trimmed_cell(cell: Any, region: Any) -> NDArray[np.float64]:
    """The part of a cell inside a region, without edges too short to print.

    Args:
        cell: The cell, a shapely polygon.
        region: A shapely polygon that it crosses.

    Returns:
        Corners (k, 2) of the largest part, counter-clockwise; corners of the whole cell stay, which neighbours share.

    Example:
        >>> import shapely
        >>> len(trimmed_cell(shapely.box(0, 0, 4, 4), shapely.box(-1, -1, 3, 5)))
        4
    """
    corners = shapely.get_coordinates(cell.exterior)[:-1]
    points = shapely.get_coordinates(shapely.geometry.polygon.orient(_largest(cell.intersection(region))).exterior)[:-1]
    own = np.hypot(*(points[:, None] - corners[None]).transpose(2, 0, 1)).min(axis=1) < 1e-6
    kept = list(range(len(points)))
    while True:
        lengths = [float(math.hypot(*(points[kept[k]] - points[kept[k - 1]]))) for k in range(len(kept))]
        k = int(np.argmin(lengths))
        if lengths[k] >= _SHORT or len(kept) <= 4:
            return np.asarray(points[kept])
        # Of the two ends of a short edge a corner of the whole cell stays, which its neighbours share.
        kept.pop(k - 1 if own[kept[k]] and not own[kept[k - 1]] else k)


def _largest(shape: Any) -> Any:
    return max((p for p in getattr(shape, "geoms", [shape]) if p.geom_type == "Polygon"), key=lambda p: p.area)
