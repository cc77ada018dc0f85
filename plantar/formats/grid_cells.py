"""Layouts of rectangular cells in rows and columns, of mats, platforms and matrix insoles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError, LayoutError
from plantar.geometry.polygon import convex_hull
from plantar.layouts.layout import DEFAULT_RANGES, Side, SoleLayout

__all__ = ["grid_cells"]


def grid_cells(
    present: NDArray[np.bool_], row_pitch: float, column_pitch: float, *, side: Side, name: str, threshold: float
) -> SoleLayout:
    """Returns a layout of the cells of a matrix that are there; the first row is the front, the first column the left.

    Its origin is in the middle of the hind edge; ids count through the whole matrix.

    Args:
        present: Which cells (rows, columns) there are.
        row_pitch: Distance of rows in m.
        column_pitch: Distance of columns in m.
        side: The foot.
        name: Name of the layout.
        threshold: Pressure in Pa from which a cell counts as loaded.

    Raises:
        FormatError: If there is no cell, or a pitch is not usable.

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
    vertices = np.column_stack([corner_x[used // (columns + 1)], corner_y[used % (columns + 1)], np.zeros(len(used))])

    number = np.full((rows + 2, columns + 2), -1)
    number[row + 1, column + 1] = np.arange(n)
    around = np.array([number[row + 1 + i, column + 1 + j] for i, j in ((-1, 0), (0, -1), (0, 1), (1, 0))]).T
    cell = row_pitch * column_pitch
    try:
        return SoleLayout(
            name=name,
            side=side,
            positions=np.column_stack([x, y, np.zeros(n)]),
            rotations=np.broadcast_to(np.eye(3), (n, 3, 3)),
            vertices=vertices,
            corners=tuple(map(tuple, corners.tolist())),
            neighbours=tuple(tuple(sorted(j for j in near if j >= 0)) for near in around.tolist()),
            areas=np.full(n, cell),
            outline=convex_hull(vertices[:, :2]),
            ids=row * columns + column + 1,
            cell_shape="rectangle",
            cell_area=cell,
            modalities=("force",),
            ranges={"force": DEFAULT_RANGES["force"]},
            thresholds={"force": threshold * cell},
        )
    except LayoutError as error:
        raise FormatError(f"the recording's own geometry is not valid: {error}") from None
