"""Layouts that a recording describes: matrices, polygons, and parts."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import FormatError, LayoutError
from plantar.geometry.polygon import area, centroid, convex_hull
from plantar.layouts.cell_layout import edge_neighbours, shared_vertices
from plantar.layouts.layout import DEFAULT_RANGES, Side, SoleLayout


def grid_cells(
    present: NDArray[np.bool_], row_pitch: float, column_pitch: float, *, side: Side, name: str, threshold: float
) -> SoleLayout:
    """Returns layout of a matrix' present cells; first row front, first column left.

    Origin in the middle of the hind edge; ids count the whole matrix.

    Args:
        present: Which cells (rows, columns) exist; FormatError without any, or for a bad pitch.
        row_pitch: Row distance in m.
        column_pitch: Column distance in m.
        side: Foot.
        name: Of the layout.
        threshold: Cell counts as loaded from this pressure in Pa.

    Example:
        >>> layout = grid_cells(np.ones((3, 2), dtype=bool), 0.01, 0.005, side="left", name="mat", threshold=1e4)
        >>> layout.positions[0].round(4).tolist(), layout.neighbours[0], len(layout)
        ([0.025, 0.0025, 0.0], (1, 2), 6)
    """
    if not (np.isfinite([row_pitch, column_pitch]).all() and min(row_pitch, column_pitch) > 0.0):
        raise FormatError(f"cells of {row_pitch} x {column_pitch} m are not possible; allowed: above 0")
    rows, columns = present.shape
    row, column = np.nonzero(present)
    n = len(row)
    if n == 0:
        raise FormatError("the matrix has no cell that measures")
    x = (rows - 1 - row + 0.5) * row_pitch
    y = (0.5 * columns - column - 0.5) * column_pitch
    corner_x = np.arange(rows, -1, -1) * row_pitch  # of the lines between rows
    corner_y = (0.5 * columns - np.arange(columns + 1)) * column_pitch

    # Counter-clockwise from the hind right corner; corners that meet are one vertex.
    ends = [(row + 1, column + 1), (row, column + 1), (row, column), (row + 1, column)]
    keys = np.array([i * (columns + 1) + j for i, j in ends]).T
    used, index = np.unique(keys, return_inverse=True)
    corners = index.reshape(n, 4)
    vertices = np.column_stack([corner_x[used // (columns + 1)], corner_y[used % (columns + 1)]])

    number = np.full((rows + 2, columns + 2), -1)
    number[row + 1, column + 1] = np.arange(n)
    around = np.array([number[row + 1 + i, column + 1 + j] for i, j in ((-1, 0), (0, -1), (0, 1), (1, 0))]).T
    neighbours = tuple(tuple(sorted(j for j in near if j >= 0)) for near in around.tolist())
    ids = row * columns + column + 1
    places = np.column_stack([x, y])
    areas = np.full(n, row_pitch * column_pitch)
    cells = ids, places, vertices, corners.tolist(), neighbours, areas
    return flat_sole(name, side, *cells, convex_hull(vertices), cell_shape="rectangle", threshold=threshold)


def polygon_layout(rings: Sequence[NDArray[np.float64]], *, ids: Sequence[int], side: Side, name: str) -> SoleLayout:
    """Returns named layout of a side from rings: corners (k, 2) of each cell in m, counter-clockwise, and ids.

    Cells sharing two corners are neighbours, the outline is the convex hull, the threshold 10 kPa. FormatError for
    repeated ids or cells without area.

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
    cells = ids, np.array([centroid(ring) for ring in rings]), vertices, corners, edge_neighbours(corners), sizes
    return flat_sole(name, side, *cells, convex_hull(vertices))


def flat_sole(
    name: str,
    side: Side,
    ids: ArrayLike,
    places: NDArray[np.float64],
    vertices: NDArray[np.float64],
    corners: Sequence[Sequence[int]],
    neighbours: tuple[tuple[int, ...], ...],
    areas: NDArray[np.float64],
    outline: NDArray[np.float64],
    *,
    cell_area: float | None = None,
    cell_shape: str = "polygon",
    threshold: float = 10e3,
) -> SoleLayout:
    """Returns flat layout of a name, side and outline (k, 2); FormatError if it is not valid.

    Its force cells have ids, places (n, 2), corners among vertices (m, 2), neighbours, areas (n,), a cell_shape and
    usual cell_area, in m, and are loaded from a threshold in Pa.
    """
    usual = cell_area or float(np.median(areas))
    try:
        return SoleLayout(
            name=name,
            side=side,
            positions=np.column_stack([places, np.zeros(len(places))]),
            rotations=np.broadcast_to(np.eye(3), (len(places), 3, 3)),
            vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
            corners=tuple(map(tuple, corners)),
            neighbours=neighbours,
            areas=areas,
            outline=outline,
            ids=np.array(ids),
            cell_shape=cell_shape,
            cell_area=usual,
            modalities=("force",),
            ranges={"force": DEFAULT_RANGES["force"]},
            thresholds={"force": threshold * usual},
        )
    except LayoutError as error:
        raise FormatError(f"the recording's own geometry is not valid: {error}") from None


def cells_by_id(layout: SoleLayout, ids: Sequence[int]) -> SoleLayout | None:
    """Returns a layout's cells of ids in their order; None for others or twice the same."""
    index = {int(v): i for i, v in enumerate(layout.ids)}
    if len(set(ids)) < len(ids) or not set(ids) <= set(index):
        return None
    order = [index[i] for i in ids]
    return layout if order == list(range(len(layout))) else subset(layout, order)


def subset(layout: SoleLayout, cells: Sequence[int]) -> SoleLayout:
    """Returns layout of cells by indices, each once, in their order; vertices and outline stay.

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
