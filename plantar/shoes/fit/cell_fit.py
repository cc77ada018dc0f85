"""Cells of a stated body on the shoe's face: tiles, films, sheet crossings. In mm."""

import math
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError, InputError
from plantar.shoes.cells.cell import Cell
from plantar.shoes.fit.cell_pattern import (
    CellPattern,
    Lattice,
    RowLattice,
    active_shape,
    joined,
    pattern_of,
    pocket_parts,
)
from plantar.shoes.fit.few_cells import fit_few_cells
from plantar.shoes.fit.lattice_fit import fit_lattice
from plantar.shoes.fit.taxels import TaxelFit, rows_and_columns
from plantar.shoes.geometry.outline import CORNER, grown, ring, tidy

LINES_MOST = 128  # most rows and columns of a sheet together

_SAMPLES = 8  # offsets of a sheet's lines along each axis
_LEAST_CELL = 0.05  # of a whole cell around a crossing: less of the sheet is a sliver

Array = NDArray[np.float64]


def fit_cells(
    foot: Any,
    cell: Cell,
    *,
    rib: float,
    taxels: int | None = None,
    overhang: float = 0.0,
    overhang_max: float = 0.0,
    border: float = 0.0,
) -> TaxelFit:
    """Fit cells of a stated body to a shoe's face.

    `foot`: Shapely outline below the rim's upper edge; `taxels`: their number, not of a sheet; None takes as many as
    fit; `overhang`: allowed cell reach beyond the outline without `taxels`; the least with them; `overhang_max`:
    allowed shoe reach beyond the outline. Returns cells, all whole but at a sheet's edge.

    Example:
        >>> import shapely
        >>> square = Cell(shape="square", size=20.0)
        >>> len(fit_cells(shapely.box(0.0, 0.0, 92.0, 70.0), square, rib=2.4).cells)
        12
    """
    if cell.kind == "sheet":
        if taxels is not None:
            raise InputError("a sheet has as many crossings as the outline holds; leave --taxels out")
        return _sheet(foot, tidy(grown(foot, overhang)), cell, rib, overhang, border)
    if cell.count:
        if taxels is not None:
            raise InputError(f"cell {cell.label} states how many a foot has ({cell.count:g}); leave --taxels out")
        return fit_few_cells(foot, tidy(grown(foot, overhang)), cell, rib=rib, overhang=overhang, border=border)
    pattern = pattern_of(cell, rib)
    if taxels is None:
        fit = fit_lattice(tidy(grown(foot, overhang)), pattern=pattern)
        reach = overhang
    else:
        room = max(overhang, overhang_max - CORNER * border)
        fit = fit_lattice(foot, taxels=taxels, overhang=overhang, overhang_max=room, pattern=pattern)
        reach = fit.overhang
    lattice = fit.lattice
    axial = fit.cells
    rooms = tuple(lattice.corners(axial))
    pockets = _placed(lattice, axial, ring(joined(pocket_parts(cell))))
    cells = rooms if cell.kind == "tile" else _placed(lattice, axial, active_shape(cell))
    return TaxelFit(
        cells=cells,
        shares=np.ones(len(cells)),
        lattice=lattice,
        cell_area=pattern.area if cell.kind == "tile" else cell.active_area,
        overhang=reach,
        sole=foot,
        border=border,
        lattice_cells=axial if cell.kind == "tile" and cell.shape == "hex" else None,
        notes=(_note(cell, pattern),),
        cell=cell,
        pockets=pockets,
        rooms=rooms,
        links=_links(pattern, lattice, axial, pockets),
    )


def _note(cell: Cell, pattern: CellPattern) -> str:
    name = cell.label
    what = {"tile": "tiles", "film": "films below lands of the pad"}[cell.kind]
    return f"cell {name}: {what}, {pattern.width:.2f} mm apart in a row, rows {pattern.rise:.2f} mm apart"


def _placed(lattice: Lattice, axial: NDArray[np.int64], shape: Array) -> tuple[Array, ...]:
    if isinstance(lattice, RowLattice):
        return tuple(lattice.shapes(axial, shape))
    c = math.cos(lattice.angle)
    s = math.sin(lattice.angle)
    return tuple(lattice.centres(axial)[:, None] + shape @ np.array([[c, s], [-s, c]]))


def _links(
    pattern: CellPattern, lattice: Lattice, axial: NDArray[np.int64], pockets: tuple[Array, ...]
) -> tuple[tuple[int, int], ...]:
    """Pairs of cells under two pitches apart, no pocket between: cable ways."""
    centres = lattice.centres(axial)
    far = 1.01 * max(pattern.width, math.hypot(0.5 * pattern.width, pattern.rise), pattern.rise)
    pairs = np.argwhere(np.triu(np.hypot(*(centres[:, None] - centres[None]).transpose(2, 0, 1)) <= far, 1))
    tree = shapely.STRtree([shapely.Polygon(p) for p in pockets])
    lines = shapely.linestrings(centres[pairs])
    met = np.zeros(len(pairs), dtype=int)
    np.add.at(met, tree.query(lines, predicate="intersects")[0], 1)
    return tuple((int(i), int(j)) for i, j in pairs[met == 2])


def _sheet(foot: Any, region: Any, cell: Cell, rib: float, overhang: float, border: float) -> TaxelFit:
    edge = region.buffer(-cell.play - 0.5 * rib, join_style="mitre")
    sheet = tidy(edge) if not edge.is_empty else edge
    inside = sheet.buffer(-cell.edge, join_style="mitre")
    if cell.circuit == "matrix":
        inside = inside & _before_tail(sheet, cell)
    at, lines = _crossings(region, inside, cell)
    outline = _around_crossing(cell)
    cells = []
    kept_lines = []
    crossings = []
    for (cx, cy), line in zip(at.tolist(), lines, strict=True):
        whole = shapely.Polygon(outline + np.array([cx, cy]))
        part = whole if sheet.covers(whole) else shapely.intersection(whole, sheet, grid_size=1e-4)
        part = max(getattr(part, "geoms", [part]), key=lambda g: g.area)
        if part.area >= _LEAST_CELL * whole.area:
            cells.append(ring(shapely.geometry.polygon.orient(part.simplify(1e-4))))
            kept_lines.append(line)
            crossings.append((cx, cy))
    found = tuple(cells)
    areas = np.array([shapely.Polygon(c).area for c in found])
    rows, columns = rows_and_columns(np.array(kept_lines))
    pattern = CellPattern(cell.pitch_x, cell.pitch_y, 0.0, (), math.pi)
    whole_area = cell.pitch_x * cell.pitch_y
    share = cell.line_width**2 / whole_area
    note = (
        f"cell {cell.label}: one sheet of {rows} rows and {columns} columns, {len(found)} crossings; "
        f"the electrodes cover {100 * share:.0f} % of a cell and stand for all of it"
    )
    recess = sheet.buffer(cell.play, join_style="mitre")
    return TaxelFit(
        cells=found,
        shares=areas / whole_area,
        lattice=RowLattice(pattern, (float(at[0, 0]), float(at[0, 1])), 0.0),
        cell_area=whole_area,
        overhang=overhang,
        sole=foot,
        border=border,
        lattice_cells=None,
        notes=(note,),
        cell=cell,
        pockets=(ring(tidy(recess)),),
        rooms=(ring(region),),
        links=(),
        lines=np.array(kept_lines, dtype=np.int64),
        crossings=np.array(crossings),
    )


def _before_tail(sheet: Any, cell: Cell) -> Any:
    """A sheet without the strip at the heel in which its lines gather to the tail: half of them from each side."""
    low_x, low_y, high_x, high_y = sheet.bounds
    lines = (high_x - low_x) / cell.pitch_x + (high_y - low_y) / cell.pitch_y + 1.0
    return shapely.box(low_x + cell.edge + 0.5 * lines * cell.tail_pitch, low_y, high_x, high_y)


def _shifted(cell: Cell) -> bool:
    """Whether every other row of a sheet is shifted by half a pitch: its columns zigzag."""
    return cell.lattice == "hex"


def _around_crossing(cell: Cell) -> Array:
    """Corners (k, 2) of what is nearer to a crossing at the origin than to any other."""
    px = 0.5 * cell.pitch_x
    py = cell.pitch_y
    if not _shifted(cell):
        return np.array([[-px, -0.5 * py], [px, -0.5 * py], [px, 0.5 * py], [-px, 0.5 * py]])
    # Of a shifted row the neighbour lies at (px, py): the bisector meets x = px and x = 0 there.
    side = (px**2 + py**2) / (2.0 * py)
    low = (px**2 + py**2 - 2.0 * px**2) / (2.0 * py)
    return np.array([[0.0, -side], [px, -low], [px, low], [0.0, side], [-px, low], [-px, -low]])


def _crossings(region: Any, inside: Any, cell: Cell) -> tuple[Array, NDArray[np.int64]]:
    """Crossings (n, 2) at the offset with most electrodes inside, and their rows and columns (n, 2)."""
    half = 0.5 * cell.line_width
    low_x, low_y, high_x, high_y = region.bounds
    most = (high_x - low_x) / cell.pitch_x + (high_y - low_y) / cell.pitch_y
    if most > LINES_MOST + 2:
        raise FootError(
            f"cell {cell.label}: a sheet of {most:.0f} rows and columns; allowed: {LINES_MOST} together, "
            "with a larger pitch_x and pitch_y"
        )
    best: tuple[tuple[float, ...], Array, NDArray[np.int64]] | None = None
    shapely.prepare(inside)
    centre = np.array([region.centroid.x, region.centroid.y])
    for u in np.arange(_SAMPLES) / _SAMPLES:
        for v in np.arange(_SAMPLES) / _SAMPLES:
            x = np.arange(low_x - u * cell.pitch_x, high_x, cell.pitch_x)
            y = np.arange(low_y - v * cell.pitch_y, high_y, cell.pitch_y)
            columns, rows = (v.ravel() for v in np.meshgrid(np.arange(len(x)), np.arange(len(y))))
            at = np.column_stack([x[columns], y[rows]])
            if _shifted(cell):
                at[:, 0] += 0.5 * cell.pitch_x * (rows % 2)
            at = at.round(4)
            boxes = shapely.box(at[:, 0] - half, at[:, 1] - half, at[:, 0] + half, at[:, 1] + half)
            within = np.zeros(len(at), dtype=bool) if inside.is_empty else shapely.covers(inside, boxes)
            kept = at[within]
            if len(kept):
                score = (float(len(kept)), -round(float(np.hypot(*(kept.mean(axis=0) - centre))), 3))
                if best is None or score > best[0]:
                    best = (score, kept, np.column_stack([_ranks(rows[within]), _ranks(columns[within])]))
    if best is None:
        raise FootError(
            f"no crossing of electrodes of {cell.line_width:g} mm lies inside the sole; use thinner lines or edge"
        )
    return best[1], best[2]


def _ranks(values: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.unique(values, return_inverse=True)[1].astype(np.int64)
