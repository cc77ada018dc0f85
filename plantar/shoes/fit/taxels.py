"""Taxels of a sole: one lattice, cells whole or rim-cut. In mm."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.optional_library import missing_libraries
from plantar.errors import FootError
from plantar.layouts.hex_lattice import HexLattice
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.cell_pattern import Lattice
from plantar.shoes.fit.lattice_fit import LatticeFit, fit_lattice
from plantar.shoes.geometry.outline import CORNER, grown, tidy

LEAST_SHARE = 0.6  # share of a cell that is left at least where the rim cuts it: below, the taxel's board does not fit

LEAST_BORDER = 0.5  # border in mm that is left around the cells where a number of them needs the room

CUT_CORNER = 1.02  # how much farther than its edges a corner of the outline that cuts cells may lie

_SAMPLES = 14  # lattice offsets along each axis of the unit cell, where cells are cut
_ANGLES = (0.0, 30.0)  # degrees, where cells are cut: rows along or across the foot

_OFF_CENTRE = 0.005  # share of a cell that a mm off the middle is worth

Cells = tuple[NDArray[np.float64], ...]


@dataclass(frozen=True)
class TaxelFit:
    """Left sole's cells.

    Attributes:
        cells: Corners (k, 2) of each, counter-clockwise, row by row.
        shares: Area (n,) over a whole cell's.
        cell_area: Whole cell in mm^2.
        overhang: Used cell reach beyond the foot's outline.
        sole: Shapely outline of the face.
        border: Left around the cells.
        lattice_cells: Axial coordinates (n, 2) if all are whole.
        blind_most: Requested widest blind rim in mm.
        cell: Body; None of skin hexagons.
        pockets: Corners (k, 2) of pockets, or a sheet's recess; None if implied by the cells.
        rooms: Corners (k, 2) within the plate; None for the cells.
        links: Cell pairs for cables; None for neighbours.
        lines: Row and column (n, 2) of sheet cells.
        crossings: Of these, (n, 2).
    """

    cells: Cells
    shares: NDArray[np.float64]
    lattice: Lattice
    cell_area: float
    overhang: float
    sole: Any
    border: float
    lattice_cells: NDArray[np.int64] | None
    notes: tuple[str, ...] = ()
    blind_most: float | None = None
    cell: Cell | None = None
    pockets: Cells | None = None
    rooms: Cells | None = None
    links: tuple[tuple[int, int], ...] | None = None
    lines: NDArray[np.int64] | None = None
    crossings: NDArray[np.float64] | None = None

    @cached_property
    def covered(self) -> float:
        """Sole area in mm^2 under the cells, which do not overlap."""
        return float(shapely.area(shapely.intersection([shapely.Polygon(c) for c in self.cells], self.sole)).sum())

    @property
    def covered_area_ratio(self) -> float:
        """Sole share under the cells, 0..1."""
        return self.covered / float(self.sole.area)

    @property
    def whole(self) -> int:
        return int((np.abs(self.shares - 1.0) < 1e-6).sum())


@missing_libraries("shoes")
def fit_taxels(
    foot: Any,
    *,
    cell_area: float = 691.0,
    taxels: int | None = None,
    overhang: float = 0.0,
    overhang_max: float = 0.0,
    border: float = 0.0,
) -> TaxelFit:
    """Fit taxels to a shoe's face: most whole cells, or a number with least overhang.

    If these do not fit, the border shrinks, then rim cells are cut.

    Args:
        foot: Shapely outline below the rim's upper edge.
        cell_area: In mm^2.
        taxels: Their number; None takes as many whole ones as fit.
        overhang: Allowed cell reach beyond the outline without `taxels`; the least with them.
        overhang_max: Allowed shoe reach beyond the outline.
        border: Wanted plate beyond the cells.

    Returns:
        Cells.

    Raises:
        InputError: If an argument is out of range.
        FootError: If they do not fit.
    """
    if taxels is None:
        fit = replace(fit_lattice(tidy(grown(foot, overhang)), cell_area=cell_area), overhang=overhang)
        return _whole(foot, fit, cell_area, border, ())
    problem: FootError | None = None
    for wanted in sorted({border, min(border, LEAST_BORDER)}, reverse=True):
        room = max(overhang, overhang_max - CORNER * wanted)
        try:
            fit = fit_lattice(foot, cell_area=cell_area, taxels=taxels, overhang=overhang, overhang_max=room)
        except FootError as error:
            problem = problem or error
            continue
        return _whole(foot, fit, cell_area, wanted, () if wanted == border else (_narrow(border),))
    border_left = min(border, LEAST_BORDER)
    cut = _cut_fit(foot, cell_area, taxels, max(overhang, (overhang_max - 0.05) / CUT_CORNER - CORNER * border_left))
    if cut is None:
        assert problem is not None
        raise problem
    notes = ((_narrow(border),) if border > border_left else ()) + cut.notes
    return replace(cut, border=border_left, notes=notes)


def _narrow(border: float) -> str:
    return f"the border around the cells is {LEAST_BORDER:g} instead of {border:g} mm: so many taxels need the room"


def _whole(sole: Any, fit: LatticeFit, cell_area: float, border: float, notes: tuple[str, ...]) -> TaxelFit:
    cells = tuple(fit.lattice.corners(fit.cells))
    return TaxelFit(
        cells=cells,
        shares=np.ones(len(cells)),
        lattice=fit.lattice,
        cell_area=cell_area,
        overhang=fit.overhang,
        sole=sole,
        border=border,
        lattice_cells=fit.cells,
        notes=notes,
    )


def rows_and_columns(lines: NDArray[np.int64]) -> tuple[int, int]:
    """Row and column counts among lines (n, 2), each cell's row and column."""
    return len(np.unique(lines[:, 0])), len(np.unique(lines[:, 1]))


def _cut_fit(sole: Any, cell_area: float, taxels: int, reach: float) -> TaxelFit | None:
    """A number of cells within a distance of the sole, least cut by the rim, or None."""
    # Gentle corners stay one point: a cut cell gets no short edges.
    region = shapely.set_precision(sole.simplify(0.1).buffer(reach, join_style="mitre", mitre_limit=CUT_CORNER), 1e-4)
    shapely.prepare(region)
    found: list[tuple[float, tuple[float, float, float]]] = []
    step = 1.0 / _SAMPLES
    trials = [(d, i * step, j * step) for d in _ANGLES for i in range(_SAMPLES) for j in range(_SAMPLES)]
    for _ in range(4):
        placed = [(_cut_placement(region, cell_area, taxels, *trial), trial) for trial in trials]
        found += [(p[0], trial) for p, trial in placed if p is not None]
        if not found:
            return None
        step /= 2.0
        degrees, i, j = max(found, key=lambda f: round(f[0], 9))[1]
        trials = [(degrees, i + a * step, j + b * step) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b]
    best = _cut_placement(region, cell_area, taxels, degrees, i, j)
    assert best is not None
    _, lattice, axial, shares = best
    cells = []
    for corners, share in zip(lattice.corners(axial), shares, strict=True):
        cells.append(corners if share > 1.0 - 1e-6 else trimmed_cell(shapely.Polygon(corners), region))
    cut = int((shares <= 1.0 - 1e-6).sum())
    note = (
        f"{taxels} whole cells do not fit within {reach:.2f} mm of the sole: {cut} cells at the "
        f"rim are cut, to {100 * shares.min():.0f} % of a cell or more"
    )
    return TaxelFit(
        cells=tuple(cells),
        shares=shares,
        lattice=lattice,
        cell_area=cell_area,
        overhang=reach,
        sole=sole,
        border=0.0,
        lattice_cells=None,
        notes=(note,),
    )


def _cut_placement(
    region: Any, cell_area: float, taxels: int, degrees: float, i: float, j: float
) -> tuple[float, HexLattice, NDArray[np.int64], NDArray[np.float64]] | None:
    """Score, lattice, axial coordinates and shares of a placement's cells that the region cuts least."""
    angle = math.radians(degrees)
    start = HexLattice(cell_area, angle=angle)
    c = math.cos(angle)
    s = math.sin(angle)
    u = i * start.width
    v = j * 1.5 * start.side
    x = region.centroid.x + c * u - s * v
    y = region.centroid.y + s * u + c * v
    lattice = HexLattice(cell_area, (round(x, 4), round(y, 4)), angle)
    box = np.array(region.bounds).reshape(2, 2)
    axial = lattice.cells_near(box[0], box[1])
    polygons = shapely.polygons(lattice.corners(axial))
    shares = np.where(shapely.contains(region, polygons), 1.0, 0.0)
    partly = np.flatnonzero((shares == 0.0) & shapely.intersects(region, polygons))
    shares[partly] = shapely.area(shapely.intersection(polygons[partly], region)) / cell_area
    order = np.sort(np.argsort(-shares, kind="stable")[:taxels])
    if len(order) < taxels or shares[order].min() < LEAST_SHARE:
        return None
    # The smallest counts as much as all together, so that no cell is given up for the others; then the middle counts.
    centre = lattice.centres(axial[order]).mean(axis=0)
    off = math.hypot(centre[0] - region.centroid.x, centre[1] - region.centroid.y)
    return (
        float(shares[order].sum() + taxels * (shares[order].min() - _OFF_CENTRE * off)),
        lattice,
        axial[order],
        shares[order],
    )


_SHORT = 1.2  # mm: shortest edge that is left


def trimmed_cell(cell: Any, region: Any) -> NDArray[np.float64]:
    """Gives corners (k, 2) of the largest part of a cell in a region, both shapely, without unprintably short edges;
    whole cells' corners stay.

    Example:
        >>> import shapely
        >>> len(trimmed_cell(shapely.box(0, 0, 4, 4), shapely.box(-1, -1, 3, 5)))
        4
    """
    corners = shapely.get_coordinates(cell.exterior)[:-1]
    points = shapely.get_coordinates(shapely.geometry.polygon.orient(_largest(cell.intersection(region))).exterior)[:-1]
    own = np.hypot(*(points[:, None] - corners[None]).transpose(2, 0, 1)).min(axis=1) < 1e-6
    kept = list(range(len(points)))
    while True:
        lengths = [float(math.hypot(*(points[kept[k]] - points[kept[k - 1]]))) for k in range(len(kept))]
        k = int(np.argmin(lengths))
        if lengths[k] >= _SHORT or len(kept) <= 4:
            return np.asarray(points[kept])
        # Of the two ends of a short edge a corner of the whole cell stays, which its neighbours share.
        kept.pop(k - 1 if own[kept[k]] and not own[kept[k - 1]] else k)


def _largest(shape: Any) -> Any:
    return max((p for p in getattr(shape, "geoms", [shape]) if p.geom_type == "Polygon"), key=lambda p: p.area)
