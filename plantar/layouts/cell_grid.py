"""Cells of a regular grid as rows and columns: no polygon a cell, however many a walkway has."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.errors import LayoutError

_NEAR = ((0, 1), (0, 2), (1, 0), (2, 0), (1, 1), (1, -1))  # steps to cells that touch, or have one between them


@dataclass(frozen=True, eq=False)
class CellGrid:
    """Some cells of a grid. Rows run along x, columns along y; the corner of cell (0, 0) is the origin.

    Attributes:
        row: Row (k,) of each cell.
        column: Column (k,) of each cell.
        pitch: Distance of rows and of columns in m.
    """

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    pitch: tuple[float, float] = field(default=(0.005, 0.005))

    def __post_init__(self) -> None:
        if self.row.shape != self.column.shape or self.row.ndim != 1:
            raise LayoutError(f"rows {self.row.shape} and columns {self.column.shape}; allowed: one of each a cell")
        if not (np.isfinite(self.pitch).all() and min(self.pitch) > 0.0):
            raise LayoutError(f"a grid's pitch is {self.pitch} m; allowed: above 0")

    def __len__(self) -> int:
        return len(self.row)

    @cached_property
    def positions(self) -> NDArray[np.float64]:
        """Centres (k, 3) in m, in the plane z = 0."""
        x, y = self.pitch
        return np.column_stack([(self.row + 0.5) * x, (self.column + 0.5) * y, np.zeros(len(self))])

    @property
    def areas(self) -> NDArray[np.float64]:
        """Areas (k,) in m^2."""
        return np.full(len(self), self.pitch[0] * self.pitch[1])

    def cell_rings(self, cells: Sequence[int] | NDArray[np.int64]) -> NDArray[np.float64]:
        """Corners (n, 4, 2) in m of some cells, counter-clockwise."""
        x, y = self.pitch
        low = np.stack([self.row[cells] * x, self.column[cells] * y], axis=-1)
        return np.asarray(low[:, None, :] + np.array([[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]]))

    def of_cells(self, cells: NDArray[np.int64] | NDArray[np.bool_]) -> "CellGrid":
        """Grid of some cells by their indices or a mask."""
        return CellGrid(self.row[cells], self.column[cells], self.pitch)

    def ends_of_rows(self, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which of some cells (n,) are the first or last of them in their row: all others lie between two of these.

        Example:
            >>> CellGrid(np.array([0, 0, 0, 1]), np.array([2, 3, 4, 3])).ends_of_rows(np.arange(4)).tolist()
            [True, False, True, True]
        """
        row = self.row[cells] - self.row[cells].min(initial=0)
        column = self.column[cells]
        first = np.full(int(row.max(initial=0)) + 1, np.iinfo(np.int64).max)
        last = np.full(len(first), np.iinfo(np.int64).min)
        np.minimum.at(first, row, column)
        np.maximum.at(last, row, column)
        return np.asarray((column == first[row]) | (column == last[row]))

    def numbers(self) -> NDArray[np.int64]:
        """Index of the cell at each place (h, w) of the box around all cells, -1 where there is none."""
        box = np.full((np.ptp(self.row) + 1, np.ptp(self.column) + 1), -1)
        box[self.row - self.row.min(), self.column - self.column.min()] = np.arange(len(self))
        return box

    def groups(self, active: NDArray[np.bool_]) -> list[list[int]]:
        """Active cells (k,) that touch, or have one between them, as a layout's neighbours and theirs.

        Example:
            >>> grid = CellGrid(np.array([0, 0, 0, 0]), np.array([0, 2, 5, 6]))
            >>> grid.groups(np.ones(4, dtype=bool))
            [[0, 1], [2, 3]]
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        chosen = np.flatnonzero(active)
        if not len(chosen):
            return []
        box = self.of_cells(chosen).numbers()
        near = np.pad(box, 2, constant_values=-1)
        here = np.flatnonzero(near.ravel() >= 0)
        flat = near.ravel()
        ends = [flat[here + along * near.shape[1] + across] for along, across in _NEAR]
        pairs = np.concatenate([np.stack([flat[here], end])[:, end >= 0] for end in ends], axis=1)
        links = coo_array((np.ones(pairs.shape[1], dtype=np.int8), pairs), shape=(len(chosen), len(chosen)))
        count, label = connected_components(links, directed=False)
        order = np.argsort(label, kind="stable")
        parts = np.split(chosen[order], np.cumsum(np.bincount(label, minlength=count))[:-1])
        return [part.tolist() for part in parts]
