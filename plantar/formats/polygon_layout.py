"""Layouts of cells that a recording describes by their corners, and parts of layouts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError, LayoutError
from plantar.geometry.polygon import area, centroid, convex_hull
from plantar.layouts.cell_layout import edge_neighbours, shared_vertices
from plantar.layouts.layout import DEFAULT_RANGES, Side, SoleLayout

__all__ = ["polygon_layout", "subset"]


def polygon_layout(rings: Sequence[NDArray[np.float64]], *, ids: Sequence[int], side: Side, name: str) -> SoleLayout:
    """Returns a layout from the corners of each cell.

    Cells that share two corners are neighbours, the outline is the convex hull, and the activation threshold is 10 kPa.

    Args:
        rings: Corners (k, 2) of each cell in the sole frame in m, counter-clockwise.
        ids: Their ids; FormatError if they are not unique, or a cell has no area.
        side: The foot.
        name: Name of the layout.

    Example:
        >>> square = np.array([[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]])
        >>> layout = polygon_layout([square, square + [0.01, 0.0]], ids=[1, 2], side="left", name="two cells")
        >>> layout.neighbours
        ((1,), (0,))
    """
    sizes = np.array([area(ring) for ring in rings])
    if not len(sizes) or not (sizes > 0.0).all():
        raise FormatError("a cell of the recording's geometry has no area")
    grain = 1e-3 * float(np.sqrt(np.median(sizes)))
    vertices, corners = shared_vertices(rings, grain)
    cell_area = float(np.median(sizes))
    try:
        return SoleLayout(
            name=name,
            side=side,
            positions=np.column_stack([np.array([centroid(ring) for ring in rings]), np.zeros(len(rings))]),
            rotations=np.broadcast_to(np.eye(3), (len(rings), 3, 3)),
            vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
            corners=tuple(corners),
            neighbours=edge_neighbours(corners),
            areas=sizes,
            outline=convex_hull(vertices),
            ids=np.array(ids),
            cell_shape="polygon",
            cell_area=cell_area,
            modalities=("force",),
            ranges={"force": DEFAULT_RANGES["force"]},
            thresholds={"force": 10e3 * cell_area},
        )
    except LayoutError as error:
        raise FormatError(f"the recording's own geometry is not valid: {error}") from None


def subset(layout: SoleLayout, cells: Sequence[int]) -> SoleLayout:
    """Returns the layout of the cells of some indices, each once, in the order given; vertices and outline stay.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> subset(layout, [3, 1]).ids.tolist()
        [3, 1]
    """
    keep = [int(c) for c in cells]
    new = {old: i for i, old in enumerate(keep)}
    return replace(
        layout,
        positions=layout.positions[keep],
        rotations=layout.rotations[keep],
        corners=tuple(layout.corners[c] for c in keep),
        neighbours=tuple(tuple(sorted(new[j] for j in layout.neighbours[c] if j in new)) for c in keep),
        areas=layout.areas[keep],
        ids=layout.ids[keep],
    )
