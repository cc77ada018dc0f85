"""Whether the cells of a layout from a file can be real: simple polygons of their areas, around their taxels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.errors import LayoutError
from plantar.layouts.layout import SoleLayout

__all__ = ["check_cells"]

_AREA = 0.1  # of a cell's area: round cells are written as polygons, curved ones seen from above
_OFF = 0.5  # of a cell's size: how far a taxel may be next to its own cell


def check_cells(layout: SoleLayout) -> None:
    """Refuse cells that contradict themselves.

    Args:
        layout: The layout.

    Raises:
        LayoutError: If a cell crosses itself or is clockwise, its area is not that of its corners, its taxel is off the
            cell, or a taxel faces out of the body.

    Example:
        >>> from plantar import grid_layout
        >>> check_cells(grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.1, 0.1)))
    """
    import shapely

    if not len(layout):
        return
    facing = layout.rotations[:, 2, 2] <= 0.0
    if facing.any():
        raise LayoutError(f"field 'rotation_taxel_to_sole' of taxel {_first(layout, facing)} points out of the body")
    cells = np.array([shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))])
    crossed = ~shapely.is_valid(cells)
    if crossed.any():
        raise LayoutError(f"field 'corners' of taxel {_first(layout, crossed)} or 'vertices' makes a cell cross itself")
    turned = ~shapely.is_ccw(shapely.get_exterior_ring(cells))
    if turned.any():
        raise LayoutError(f"field 'corners' of taxel {_first(layout, turned)} goes round 'vertices' clockwise")
    seen, flat = layout.areas * layout.rotations[:, 2, 2], shapely.area(cells)  # both from above
    wrong = np.abs(flat - seen) > _AREA * np.maximum(flat, seen)
    if wrong.any():
        i = int(np.flatnonzero(wrong)[0])
        stated = f"field 'area' of taxel {layout.ids[i]} is {layout.areas[i]:.3g} m^2"
        raise LayoutError(f"{stated}; its corners in 'vertices' enclose {flat[i]:.3g} m^2")
    off = shapely.distance(cells, shapely.points(layout.positions[:, :2])) > _OFF * np.sqrt(flat)
    if off.any():
        raise LayoutError(f"field 'position' of taxel {_first(layout, off)} lies beside its cell of 'vertices'")


def _first(layout: SoleLayout, mask: NDArray[np.bool_]) -> int:
    """Id of the first taxel of a mask."""
    return int(layout.ids[np.flatnonzero(mask)[0]])
