"""Cells of a sole clipped by straight lines."""

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array
from plantar.kernels.geometry.cut_cells import cut_cells
from plantar.layouts.layout import SoleLayout


def half_planes(lines: ArrayLike, name: str = "lines") -> NDArray[np.float64]:
    """Returns half-planes (m, 3) n . x <= h of a caller's `lines`, not copied if float64; an empty list is none.

    An InputError with their `name` unless (m, 3) and finite.
    """
    if isinstance(lines, list | tuple) and not len(lines):
        return np.empty((0, 3))
    return array(lines, name, ("m", 3), finite=True)


class CellCutter:
    """Clips one sole's cells by half-planes.

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
    def of_polygons(cls, polygons: Sequence[NDArray[np.float64]] | NDArray[np.float64]) -> Self:
        """Cutter of cells given by corners (k, 2) in m each, or (n, k, 2) of all, counter-clockwise."""
        cutter = cls.__new__(cls)
        if isinstance(polygons, np.ndarray):
            count, corners = polygons.shape[:2]
            cutter._set(polygons.reshape(-1, 2), corners * np.arange(count + 1))
        else:
            cutter._set(np.concatenate(polygons), np.cumsum([0, *map(len, polygons)]))
        return cutter

    def _set(self, points: NDArray[np.float64], start: NDArray[np.integer[Any]]) -> None:
        self.points = np.ascontiguousarray(points)
        self._start = start.astype(np.intp)
        self._make_room(int(np.diff(self._start).max(initial=3)) + 4)

    def cut(self, lines: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Clip every cell.

        Args:
            lines: Half-planes (m, 3) n . x <= h in sole frame: outward normal of length 1, and h in m.

        Returns:
            Each cell's area left in m^2 and first moments in m^3 about sole origin (n, 3), and cuts' chords (n, m, 3):
            length and middle (x, y) in m, of one piece where a cell has dents.
        """
        lines = np.ascontiguousarray(half_planes(lines))
        n = len(self._start) - 1
        measure = np.empty((n, 3))
        chords = np.empty((n, len(lines), 3))
        while not cut_cells(self.points, self._start, lines, self._scratch, self._tags, measure, chords):
            self._make_room(2 * self._scratch.shape[1])
        return measure, chords

    def _make_room(self, corners: int) -> None:
        self._scratch = np.empty((2, corners, 2))
        self._tags = np.empty((2, corners), dtype=np.intp)
