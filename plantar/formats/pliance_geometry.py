"""The table of cell corners that a pliance export appends to its frames."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from plantar.formats.polygon_layout import polygon_layout
from plantar.layouts.layout import Side, SoleLayout

__all__ = ["corner_table", "layout_of_corners"]


def corner_table(tail: list[str], cells: int, warnings: list[str]) -> NDArray[np.float64] | None:
    """Returns corners (cells, 4, 2) in m in the file's axes, from the rows "x[0]" .. "y[3]" (in cm); None without a
    whole table.

    Args:
        tail: The lines after the frames.
        cells: Number of cells.
        warnings: List to which an incomplete table is reported.
    """
    rows: dict[str, list[float]] = {}
    for line in tail:
        match = re.match(r"\s*([xy]\[[0-3]\])\s+(.*)", line)
        if match:
            try:
                rows[match[1]] = [float(v.replace(",", ".")) for v in match[2].split()]
            except ValueError:
                rows[match[1]] = []
    if not rows:
        return None
    names = [f"{axis}[{corner}]" for corner in range(4) for axis in "xy"]
    if any(len(rows.get(name, [])) != cells for name in names):
        warnings.append("the file's table of cell corners is not whole: not used")
        return None
    corners = np.array([rows[name] for name in names]).T.reshape(cells, 4, 2) * 1e-2
    if not np.isfinite(corners).all():
        warnings.append("the file's table of cell corners holds values that are not numbers: not used")
        return None
    return corners


def layout_of_corners(corners: NDArray[np.float64], cells: list[int], side: Side) -> SoleLayout:
    """Returns a layout of quadrilateral cells; the file's y becomes x (forward), its x becomes -y (to the right).

    Args:
        corners: Corners (n, 4, 2) in m in the file's axes, in any order.
        cells: Ids of the cells.
        side: "left" or "right".
    """
    import shapely  # only where a file brings its own geometry

    turned = np.stack([corners[:, :, 1], -corners[:, :, 0]], axis=-1)
    polygons = [shapely.geometry.polygon.orient(shapely.MultiPoint(c).convex_hull) for c in turned]
    rings = [np.array(p.exterior.coords)[:-1] for p in polygons]
    return polygon_layout(rings, ids=cells, side=side, name="pliance mat")
