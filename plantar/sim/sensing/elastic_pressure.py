"""Spread a normal load over taxels of an elastic layer: the second taxel model.

Unlike the springs of `SolePressure`, neighbours move each other (`plantar.sim.sensing.elastic_layer`), which the
controller does not assume. Forces are linear in the wrench while the same squares touch; that matrix is kept.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.cell_cutting import CellCutter
from plantar.geometry.polygon import area as polygon_area
from plantar.geometry.polygon import convex_hull
from plantar.kernels.geometry import convex
from plantar.layouts.layout import SoleLayout
from plantar.sensing.cell_patch import reach_of
from plantar.sim.sensing.contact_patch import Patches, patch_polygon
from plantar.sim.sensing.elastic_layer import LayerContact, influence
from plantar.sim.sensing.sole_pressure import SolePressure

_GRID = 2.5e-4  # m: patches that agree within this are the same patch
_MOST_PATCHES = 64
_FINENESS = 0.4  # of a taxel's size: side of a square
_INSIDE = 0.1  # of a square: how far inside the outermost squares a load acts, so that three at least carry it
_STAYS = 1e-4  # of the load: the same squares touch while none pulls, or is penetrated, by more
_LEAST_SHARE = 0.02  # of a square: less cover than this carries nothing


class _Squares(NamedTuple):
    cutter: CellCutter
    square: NDArray[np.intp]  # (n,)
    taxel: NDArray[np.intp]  # (n,)
    side: float
    centers: NDArray[np.float64]  # (m, 2)
    compliance: NDArray[np.float64]  # (m, m): of whole squares


class _Patch:
    """What does not depend on the load, and how the touching squares answer.

    `shares` (taxels, k) of each square's force; `reach`: polygon in which a load can act.
    """

    def __init__(
        self,
        points: NDArray[np.float64],
        compliance: NDArray[np.float64],
        shares: NDArray[np.float64],
        inside: float,
    ) -> None:
        self.contact = LayerContact(compliance, points)
        self.shares = shares
        self.reach = reach_of(convex_hull(points), inside)
        self._on: NDArray[np.bool_] | None = None
        # what squares and taxels carry of a load (1, x, y)
        self._squares = np.empty((0, 3))
        self._taxels = self._squares

    def forces(self, load: NDArray[np.float64]) -> NDArray[np.float64]:
        if self._on is not None and float((self._squares @ load).min()) >= -_STAYS:
            return np.asarray(self._taxels @ load)
        pressed = self.contact.press(load, start=self._on)
        self._on = None
        if not pressed.settled:
            return np.asarray(self.shares @ (pressed.forces / pressed.forces.sum()))
        self._on = pressed.on
        gains, sunk = (part[:, :3] for part in self.contact.gains(pressed.on))
        points = self.contact.points
        back = np.linalg.inv(np.vstack([gains.sum(axis=0), points.T @ gains]))
        # Of a square that does not touch: less the force that would press it down to where the body is.
        missing = -sunk / np.diag(self.contact.compliance)[:, None]
        self._squares = np.where(pressed.on[:, None], gains, missing) @ back
        self._taxels = self.shares @ gains @ back
        return np.asarray(self.shares @ pressed.forces)


class ElasticPressure:
    """Spreads a normal load over an elastic layer's taxels; interface of `SolePressure`.

    `thickness` of the layer in m; infinity for the half-space; `rubber`: half width in m of a line contact.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> pressure = ElasticPressure(layout, thickness=0.012)
        >>> force = pressure.spread([(0.0, -0.05), (0.1, -0.05), (0.1, 0.05), (0.0, 0.05)], 100.0, (0.05, 0.0))
        >>> round(float(force.sum()), 9), bool(force[layout.positions[:, 0] < -0.02].max() == 0)
        (100.0, True)
    """

    def __init__(self, layout: SoleLayout, *, thickness: float, rubber: float = 3e-3) -> None:
        self._springs = SolePressure(layout, rubber=rubber)  # checks the layout, and carries what rests on its bare rim
        self.layout = layout
        self.thickness = thickness
        self.rubber = rubber
        self._squares = self._grid()
        self._patches = Patches(self._make_patch, _GRID, _MOST_PATCHES)

    def spread(
        self, patch: Sequence[tuple[float, float]], force: float, center_of_pressure: tuple[float, float]
    ) -> NDArray[np.float64]:
        """Taxel forces of a load on a patch.

        `patch`: contact points (k, 2) in the sole frame in m; `force`: normal force in N; 0 or less loads no taxel;
        `center_of_pressure` (2,) in the sole frame in m, moved to the nearest possible. Returns (n,) in N, none
        negative, with vertical sum `force`.
        """
        if not (0.0 < force < math.inf) or not len(patch):
            return np.zeros(len(self.layout))
        shape = self._patches.of(patch)
        if shape is None:
            return self._springs.spread(patch, force, center_of_pressure)
        x, y = convex.nearest(shape.reach, *center_of_pressure)
        carried = np.maximum(shape.forces(np.array([1.0, x, y])), 0.0)
        return self._springs.along_taxels(force / float(carried.sum()) * carried)

    def _grid(self) -> _Squares:
        import shapely

        cells = np.array([shapely.Polygon(self.layout.cell_polygon(i)) for i in range(len(self.layout))])
        side = _FINENESS * math.sqrt(self.layout.cell_area)
        x0, y0, x1, y1 = shapely.total_bounds(cells).tolist()
        xs = 0.5 * (x0 + x1) + side * (np.arange(nx := math.ceil((x1 - x0) / side)) - 0.5 * (nx - 1))
        ys = 0.5 * (y0 + y1) + side * (np.arange(ny := math.ceil((y1 - y0) / side)) - 0.5 * (ny - 1))
        centers = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
        half = 0.5 * side
        squares = shapely.box(*(centers - half).T, *(centers + half).T)
        square, taxel = shapely.STRtree(cells).query(squares, predicate="intersects")
        pieces = shapely.intersection(squares[square], cells[taxel])
        kept = shapely.area(pieces) > 1e-6 * side * side
        used, square = np.unique(square[kept], return_inverse=True)
        rings = [np.asarray(p.exterior.coords)[:-1] for p in shapely.orient_polygons(shapely.convex_hull(pieces[kept]))]
        centers = centers[used]
        compliance = influence(centers, np.full(len(centers), side), self.thickness)
        return _Squares(CellCutter.of_polygons(rings), square, taxel[kept], side, centers, compliance)

    def _make_patch(self, points: NDArray[np.float64]) -> _Patch | None:
        squares = self._squares
        polygon, lines = patch_polygon(points, self.rubber)
        measure = squares.cutter.cut(lines)[0]
        count = len(squares.centers)
        covered = np.column_stack([np.bincount(squares.square, column, count) for column in measure.T])
        if covered[:, 0].sum() <= 0.5 * polygon_area(polygon):
            return None
        whole = squares.side**2
        used = np.flatnonzero(covered[:, 0] > _LEAST_SHARE * whole)
        if len(used) < 3:
            return None
        place = covered[used, 1:] / covered[used, :1]
        area = covered[used, 0]
        compliance = squares.compliance[np.ix_(used, used)]
        cut = np.flatnonzero(area < (1.0 - 1e-9) * whole)
        if len(cut):  # a square that an edge cuts presses on a smaller one, about the middle of what is left
            order = np.concatenate([cut, np.setdiff1d(np.arange(len(used)), cut)])
            column = influence(place[order], np.sqrt(area[cut]), self.thickness)
            compliance[np.ix_(order, cut)] = column
            compliance[np.ix_(cut, order)] = column.T
            both = column[: len(cut)]
            compliance[np.ix_(cut, cut)] = 0.5 * (both + both.T)
        number = np.full(count, -1)
        number[used] = np.arange(len(used))
        shares = np.zeros((len(self.layout), len(used)))
        mine = number[squares.square] >= 0
        np.add.at(shares, (squares.taxel[mine], number[squares.square[mine]]), measure[mine, 0])
        return _Patch(place, compliance, shares / area, _INSIDE * squares.side)
