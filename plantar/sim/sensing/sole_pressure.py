"""Spread a normal load over the taxels of a sole (model "contact patches").

The contact points of each geom pair span a patch, whose cells share the pair's exact normal wrench (fz, tx, ty) as an
elastic foundation that cannot pull (Winkler):

    f_i = A_i max(0, a + b x_i + c y_i)      with a, b, c fitted to the wrench,

A_i the covered area of cell i and (x_i, y_i) its centroid. A load beyond the outermost centroids goes to the nearest
point among them, one on the bare rim to the nearest cells. Forces add up to the true one.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import LayoutError
from plantar.geometry.cell_cutting import CellCutter
from plantar.geometry.polygon import area as polygon_area
from plantar.kernels.contacts.pressed_patch import PressedPatch
from plantar.kernels.contacts.pressed_sole import PressedSole
from plantar.layouts.layout import SoleLayout
from plantar.sensing.cell_patch import pressed_patch
from plantar.sim.sensing.contact_patch import MOST_PATCHES, PATCH_GRID, patch_polygon

_LEAST_SHARE = 0.01  # of a cell: less cover than this carries nothing


class SolePressure:
    """Spreads a normal load over the taxels of a sole.

    Args:
        layout: The sole.
        rubber: Its thickness in m: half width of a line contact.

    Raises:
        LayoutError: If a taxel faces away.

    Attributes:
        springs: Kernel of the cells.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> pressure = SolePressure(layout)
        >>> force = pressure.spread([(0.0, -0.05), (0.1, -0.05), (0.1, 0.05), (0.0, 0.05)], 100.0, (0.05, 0.0))
        >>> round(float(force.sum()), 9), bool(force[layout.positions[:, 0] < -0.02].max() == 0)
        (100.0, True)
    """

    def __init__(self, layout: SoleLayout, *, rubber: float = 3e-3) -> None:
        import shapely  # 0.2 s: only where a skin is made

        facing = layout.rotations[:, 2, 2]
        if len(layout) == 0 or not (facing > 0.1).all():
            raise LayoutError("layout field 'rotations' holds a taxel that does not face the ground, or none at all")
        self.layout = layout
        self.rubber = rubber
        self._cells = np.array([shapely.Polygon(layout.cell_polygon(i)) for i in range(len(layout))])
        self._area = shapely.area(self._cells)
        # Cells that do not touch each other, such as round ones, cover a part of what lies between them only.
        self._hull = None if any(layout.neighbours) else shapely.MultiPoint(layout.vertices[:, :2]).convex_hull
        self._least = _LEAST_SHARE * self._area
        self._tree: Any = None  # of the cells, for patches on the bare rim
        self._cutter = CellCutter(layout)
        self._gain = None if (facing == 1.0).all() else 1.0 / facing
        gains = np.ones(len(layout)) if self._gain is None else self._gain
        self.springs = PressedSole(gains, PATCH_GRID, MOST_PATCHES, self._make_patch)

    def spread(
        self, patch: Sequence[tuple[float, float]], force: float, center_of_pressure: tuple[float, float]
    ) -> NDArray[np.float64]:
        """Taxel forces of a load on a patch.

        Args:
            patch: Contact points (k, 2) in the sole frame in m.
            force: Normal force in N; 0 or less loads no taxel.
            center_of_pressure: (2,) in the sole frame in m.

        Returns:
            (n,) in N, none negative, with vertical sum `force`.
        """
        if not (0.0 < force < math.inf) or not len(patch):
            return np.zeros(len(self.layout))
        return np.asarray(self.springs.spread(patch, force, *center_of_pressure))

    def along_taxels(self, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (n,) in N along taxel axes of vertical ones (n,)."""
        return force if self._gain is None else np.asarray(force * self._gain)

    def _make_patch(self, points: NDArray[np.float64]) -> PressedPatch:
        polygon, lines = patch_polygon(points, self.rubber)
        measure = self._cutter.cut(lines)[0]
        area = measure[:, 0]
        if area.sum() > 0.5 * self._within_cells(polygon):
            cells = np.flatnonzero(area > self._least)
            area = area[cells]
            points = measure[cells, 1:] / area[:, None]
        else:  # on the bare rim next to the cells
            cells, area, points = self._nearest_cells(polygon)
        return pressed_patch(cells, area, points)

    def _within_cells(self, polygon: NDArray[np.float64]) -> float:
        if self._hull is None:
            return polygon_area(polygon)
        import shapely

        within = shapely.Polygon(polygon).intersection(self._hull).area
        return float(within * float(self._area.sum()) / self._hull.area)

    def _nearest_cells(
        self, polygon: NDArray[np.float64]
    ) -> tuple[NDArray[np.intp], NDArray[np.float64], NDArray[np.float64]]:
        """Cells (m,) nearest to a patch's edge, points of each (m,), and means (m, 2)."""
        import shapely

        rim = shapely.get_coordinates(shapely.segmentize(shapely.Polygon(polygon), 0.5 * self.rubber))
        if self._tree is None:
            self._tree = shapely.STRtree(self._cells)
        nearest = self._tree.nearest(shapely.points(rim))
        count = np.bincount(nearest)
        cells = np.flatnonzero(count)
        share = count[cells].astype(np.float64)
        return cells, share, np.column_stack([np.bincount(nearest, v)[cells] for v in rim.T]) / share[:, None]
