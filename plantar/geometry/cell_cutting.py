"""What straight lines leave of a sole's cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arrays import array
from plantar.kernels.geometry.cut_cells import cut_cells
from plantar.layouts.layout import SoleLayout

__all__ = ["CellCutter", "half_planes"]


def half_planes(lines: ArrayLike, name: str = "lines") -> NDArray[np.float64]:
    """Half-planes as a caller hands them over; an empty list is none.

    Args:
        lines: Half-planes (m, 3) n . x <= h.
        name: What they are, the subject of an error.

    Returns:
        Half-planes (m, 3), not copied where they are an array of float64.

    Raises:
        InputError: If these are not (m, 3) finite numbers.

    Example:
        >>> half_planes([]).shape, half_planes([[1, 0, 0.5]]).tolist()
        ((0, 3), [[1.0, 0.0, 0.5]])
    """
    if isinstance(lines, list | tuple) and not len(lines):
        return np.empty((0, 3))
    return array(lines, name, ("m", 3), finite=True)


class CellCutter:
    """Clips the cells of one sole by half-planes; keeps the room that the kernel works in.

    Args:
        layout: The sole, n cells, convex or not.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.12, -0.07], [0.12, -0.07], [0.12, 0.07], [-0.12, 0.07]], clip=False)
        >>> measure, _ = CellCutter(layout).cut([[1.0, 0.0, 0.0]])
        >>> round(float(measure[:, 0].sum() / (layout.cell_area * len(layout))), 6)
        0.5
    """

    def __init__(self, layout: SoleLayout) -> None:
        self._set(layout.vertices[layout.corner_vertex, :2], layout.corner_start)

    @classmethod
    def of_polygons(cls, polygons: Sequence[NDArray[np.float64]]) -> Self:
        """A cutter of other cells than a layout's.

        Args:
            polygons: Corners (k, 2) of each cell in m, counter-clockwise.

        Returns:
            The cutter.

        Example:
            >>> square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
            >>> CellCutter.of_polygons([square, square + 1.0]).cut([[1.0, 0.0, 0.5]])[0][:, 0].tolist()
            [0.5, 0.0]
        """
        cutter = cls.__new__(cls)
        cutter._set(np.concatenate(polygons), np.cumsum([0, *map(len, polygons)]))
        return cutter

    def _set(self, points: NDArray[np.float64], start: NDArray[np.integer[Any]]) -> None:
        """Take over the corners (m, 2) of all cells and where each cell's begin (n + 1,)."""
        self.points = np.ascontiguousarray(points)
        self._start = start.astype(np.intp)
        self._make_room(int(np.diff(self._start).max(initial=3)) + 4)

    def cut(self, lines: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Clip every cell.

        Args:
            lines: Half-planes (m, 3) n . x <= h in the sole frame: outward normal of length 1, and h in m.

        Returns:
            Area in m^2 of what is left of each cell and its first moments in m^3 about the sole frame's origin, (n, 3),
            and the chords (n, m, 3) along which lines cut: length in m, and middle (x, y) in m.

        Raises:
            InputError: If these are not (m, 3) finite numbers.
        """
        lines = np.ascontiguousarray(half_planes(lines))
        n = len(self._start) - 1
        measure, chords = np.empty((n, 3)), np.empty((n, len(lines), 3))
        while not cut_cells(self.points, self._start, lines, self._scratch, self._tags, measure, chords):
            self._make_room(2 * self._scratch.shape[1])
        return measure, chords

    def _make_room(self, corners: int) -> None:
        self._scratch = np.empty((2, corners, 2))
        self._tags = np.empty((2, corners), dtype=np.intp)
