"""A few large cells, as load cells: as far apart as the sole allows. In mm."""

import math
from itertools import combinations
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.cell_pattern import CellPattern, RowLattice, active_shape, joined, pocket_parts
from plantar.shoes.fit.taxels import TaxelFit
from plantar.shoes.geometry.outline import ring

Array = NDArray[np.float64]


def fit_few_cells(foot: Any, region: Any, cell: Cell, *, rib: float, overhang: float, border: float) -> TaxelFit:
    """Fit `cell.count` cells into a shapely `region` of a `foot`'s outline, each at the place that lies farthest out in
    its own direction: of four, both corners of heel and toes.

    FootError where they do not fit.

    Example:
        >>> import shapely
        >>> corners = Cell(shape="round", size=20.0, thickness=5.0, count=4)
        >>> face = shapely.box(0.0, 0.0, 200.0, 90.0)
        >>> fit = fit_few_cells(face, face, corners, rib=2.4, overhang=0.0, border=2.0)
        >>> [tuple(int(v) for v in cell.mean(axis=0).round()) for cell in fit.cells]
        [(11, 11), (189, 11), (11, 79), (189, 79)]
    """
    body = joined(pocket_parts(cell, 0.5 * rib))
    reach = float(np.hypot(*shapely.get_coordinates(body).T).max())
    room = region.buffer(-reach)
    count = int(cell.count)
    if room.is_empty:
        raise FootError(f"no cell {cell.label} of {2.0 * reach:.1f} mm with its rib fits into the sole")
    centres = _far_apart(room, count)
    apart = min((math.dist(a, b) for a, b in combinations(centres.tolist(), 2)), default=math.inf)
    if apart < 2.0 * reach:
        raise FootError(
            f"{count} cells {cell.label} lie {apart:.1f} mm apart on this sole; allowed: {2.0 * reach:.1f} mm or more, "
            "with smaller cells"
        )
    pockets = tuple(at + ring(joined(pocket_parts(cell))) for at in centres)
    rooms = tuple(at + ring(body) for at in centres)
    cells = rooms if cell.kind == "tile" else tuple(at + active_shape(cell) for at in centres)
    pattern = CellPattern(2.0 * reach, 2.0 * reach, 0.0, (), 2.0 * math.pi)
    area = float(shapely.Polygon(cells[0]).area)
    return TaxelFit(
        cells=cells,
        shares=np.ones(count),
        lattice=RowLattice(pattern, (float(centres[0, 0]), float(centres[0, 1])), 0.0),
        cell_area=area,
        overhang=overhang,
        sole=foot,
        border=border,
        lattice_cells=None,
        notes=(f"cell {cell.label}: {count} of them, {apart:.0f} mm or more apart",),
        cell=cell,
        pockets=pockets,
        rooms=rooms,
        links=_links(region, centres, pockets),
    )


def _far_apart(room: Any, count: int) -> Array:
    """Points (count, 2) of a shapely room, each farthest out in its direction of an ellipse of the room's extent."""
    corners = shapely.get_coordinates(room)
    half = 0.5 * np.ptp(corners, axis=0)
    half = np.where(half > 0.0, half, 1.0)
    turns = 2.0 * math.pi * (np.arange(count) + 0.5) / count
    ways = np.column_stack([np.cos(turns), np.sin(turns)]) / half
    found = corners[(ways @ corners.T).argmax(axis=1)]
    return np.asarray(found[np.lexsort((found[:, 0], found[:, 1]))])


def _links(region: Any, centres: Array, pockets: tuple[Array, ...]) -> tuple[tuple[int, int], ...]:
    """Pairs of cells with a way between them that stays in the region and meets no other pocket."""
    shapes = [shapely.Polygon(p) for p in pockets]
    found = []
    for i, j in combinations(range(len(centres)), 2):
        line = shapely.LineString(centres[[i, j]])
        if region.covers(line) and sum(line.intersects(q) for q in shapes) == 2:
            found.append((i, j))
    return tuple(found)
