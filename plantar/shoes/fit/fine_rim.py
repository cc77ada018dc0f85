"""Fine rim: smaller cells along the edge measure loads near it. In mm.

A strip of one depth is cut across into cells, one for each sharp corner; inside lies the lattice, whole or trimmed.
"""

from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.fit.cell_pattern import Lattice, hex_pattern
from plantar.shoes.fit.lattice_fit import fit_lattice
from plantar.shoes.fit.taxels import TaxelFit, trimmed_cell
from plantar.shoes.geometry.outline import gathered, grown, tidy

# Widest blind rim in mm that a fine rim leaves: the contact face beyond the hull of the cells' centres
BLIND_MOST = 12.0

_RESERVE = 0.5  # mm: what a wall that the load case raises adds
_DEPTHS = tuple(np.arange(18.0, 7.5, -1.0).tolist())  # of the strip
_LENGTHS = (28.0, 21.0, 15.0)  # of a cell along the edge: the width of a cell of 691 mm^2 first
_LEAST_AREA = 60.0  # mm^2: below, a board has no room for a connector
_TRIMMED = 0.4  # of a cell: what is left of it next to the strip where it is kept
_DETAIL = 0.4  # mm of the edge's detail that is dropped
_CLEAR = 0.8  # mm between the strip and what would touch it in a point
_SNAP = 3.0  # mm: a cut nearer to a corner of the edge goes through the corner
_SHARP = np.radians(50.0)  # a corner that turns by more has its own cell

Array = NDArray[np.float64]


def blind_rim(face: Any, centres: Array) -> float:
    """Gives largest distance in mm of a shapely face from the hull of cell centres (n, 2).

    Example:
        >>> import shapely
        >>> blind_rim(shapely.box(0, 0, 10, 4), np.array([[2.0, 2.0], [8.0, 2.0]]))
        2.8284271247461903
    """
    corners = shapely.points(shapely.get_coordinates(face.exterior))
    return float(shapely.distance(corners, shapely.MultiPoint(centres).convex_hull).max())


def strip_cells(region: Any, face: Any, cell_area: float) -> tuple[tuple[Array, ...], Any]:
    """Cells along a region's edge: the fewest, with those inside, that the blind rim allows.

    `cell_area`: whole cell in mm^2. Returns corners (k, 2) of each cell, counter-clockwise, once around; and the
    shapely polygon inside.
    """
    found: list[tuple[float, list[Any], Any]] = []
    edge = shapely.geometry.polygon.orient(shapely.Polygon(region.exterior).simplify(_DETAIL))
    for depth in _DEPTHS:
        inside = edge.buffer(-depth, join_style="mitre", mitre_limit=2.0)
        if inside.geom_type != "Polygon" or inside.is_empty:
            continue
        inside = shapely.geometry.polygon.orient(inside.simplify(_DETAIL))
        for length in _LENGTHS:
            cells = _strip(edge, inside, depth, length)
            if not cells or not all(c.is_valid and c.area >= _LEAST_AREA for c in cells):
                continue
            if blind_rim(face, shapely.get_coordinates(shapely.centroid(cells))) <= BLIND_MOST - _RESERVE:
                found.append((len(cells) + inside.area / cell_area, cells, inside))
    if found:
        _, cells, inside = min(found, key=lambda f: f[0])
        return tuple(shapely.get_coordinates(c.exterior)[:-1] for c in cells), inside
    raise FootError(
        f"a fine rim with cells of {_LEAST_AREA:g} mm^2 or more leaves a blind rim of more than {BLIND_MOST:g} mm "
        "here; use a narrower border, or smaller cells without a fine rim"
    )


class _Line:
    """Closed line; places are distances from its first corner."""

    def __init__(self, polygon: Any) -> None:
        self.ring = polygon.exterior
        self.points = shapely.get_coordinates(self.ring)[:-1]
        steps = np.roll(self.points, -1, axis=0) - self.points
        self.starts = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
        self.length = float(self.starts[-1])
        self.headings = np.arctan2(steps[:, 1], steps[:, 0])

    def turns(self) -> Array:
        return np.asarray((self.headings - np.roll(self.headings, 1) + np.pi) % (2.0 * np.pi) - np.pi)

    def nearest(self, point: Array) -> float:
        at = float(self.ring.project(shapely.Point(point)))
        off = np.abs(self.starts - at)
        return float(self.starts[int(off.argmin())]) % self.length if off.min() < _SNAP else at

    def at(self, place: float) -> Array:
        return np.array(self.ring.interpolate(place % self.length).coords[0])

    def between(self, start: float, end: float) -> Array:
        end = end if end >= start - 1e-9 else end + self.length
        around = np.concatenate([self.starts[:-1], self.starts[:-1] + self.length])
        passed = np.flatnonzero((around > start + 1e-6) & (around < end - 1e-6)) % len(self.points)
        return np.concatenate([self.at(start)[None], self.points[passed], self.at(end)[None]])


def _strip(edge: Any, inside: Any, depth: float, length: float) -> list[Any]:
    inner = _Line(inside)
    outer = _Line(edge)
    cuts = _cuts(inner, outer, depth, length)
    cells = []
    for (a, b), (c, d) in zip(cuts, [*cuts[1:], cuts[0]], strict=True):
        ring = np.concatenate([outer.between(b, d), [inner.at(a)] if a == c else inner.between(a, c)[::-1]])
        ring = ring[np.hypot(*(ring - np.roll(ring, 1, axis=0)).T) > 1e-6]
        if len(ring) < 3:
            return []
        cells.append(shapely.Polygon(ring))
    whole = edge.area - inside.area
    return cells if abs(sum(c.area for c in cells) - whole) < 1e-3 * whole else []


def _cuts(inner: _Line, outer: _Line, depth: float, length: float) -> list[tuple[float, float]]:
    sharp = np.flatnonzero(inner.turns() > _SHARP)
    fixed = inner.starts[sharp].tolist() or [0.0]
    out: list[tuple[float, float]] = []
    for low, high in pairwise([*fixed, fixed[0] + inner.length]):
        count = max(1, round((high - low) / length))
        if len(sharp):
            k = int(sharp[fixed.index(low)])
            for heading in (inner.headings[k - 1], inner.headings[k]):  # feet of the perpendiculars on both edges
                foot = inner.points[k] + depth * np.array([np.sin(heading), -np.cos(heading)])
                out.append((low, outer.nearest(foot)))
        else:
            out.append((low, outer.nearest(inner.at(low))))
        for at in np.linspace(low, high, count + 1)[1:-1].tolist():
            place = inner.nearest(inner.at(at))
            out.append((place, outer.nearest(inner.at(place))))
    return list(dict.fromkeys(out))


def _core(inside: Any, cell_area: float) -> tuple[list[Array], Lattice]:
    clear = inside.buffer(-_CLEAR, join_style="mitre")
    try:
        lattice: Lattice = fit_lattice(clear, cell_area=cell_area).lattice
    except FootError:  # too narrow for a whole one
        lattice = hex_pattern(cell_area).at((inside.centroid.x, inside.centroid.y), 0.0)
    box = np.array(inside.bounds).reshape(2, 2)
    corners = lattice.corners(lattice.cells_near(box[0], box[1]))
    cells = shapely.polygons(corners)
    whole = shapely.covers(clear.buffer(0.01), cells)
    left = shapely.area(shapely.intersection(cells, inside)) / cell_area
    kept = []
    for i in np.flatnonzero(left >= _TRIMMED):
        cell = corners[i] if whole[i] else trimmed_cell(cells[i], inside)
        meets = shapely.line_merge(shapely.Polygon(cell).exterior.intersection(inside.exterior.buffer(1e-2)))
        # Grooves that meet in one point would leave an edge of four faces.
        long = shapely.length(shapely.get_parts(meets)).min(initial=np.inf) > _SNAP
        kept.append(cell if whole[i] or long else trimmed_cell(cells[i], clear))
    return kept, lattice


def fit_fine_rim(foot: Any, *, cell_area: float, overhang: float, border: float) -> TaxelFit:
    """Fit taxels with a fine rim to a shoe's face.

    `foot`: Shapely outline below the rim's upper edge; `cell_area`: whole cell in mm^2; `overhang`: allowed cell reach
    beyond the outline in mm; `border`: plate beyond the cells in mm. Returns cells, heel to toes.
    """
    region = tidy(grown(foot, overhang))
    face = tidy(grown(foot, overhang + border))
    strip, inside = strip_cells(region, face, cell_area)
    core, lattice = _core(inside, cell_area)
    polygons = [shapely.Polygon(c) for c in (*strip, *(gathered(c, np.concatenate(strip)) for c in core))]
    polygons.sort(key=lambda c: (round(c.centroid.x, 3), round(c.centroid.y, 3)))
    areas = shapely.area(polygons)
    cells = tuple(shapely.get_coordinates(c.exterior)[:-1] for c in polygons)
    least = min(shapely.Polygon(c).area for c in strip)
    note = f"fine rim: {len(strip)} cells of {least:.0f} mm^2 or more along the edge, {len(core)} of a lattice inside"
    return TaxelFit(
        cells=cells,
        shares=areas / cell_area,
        lattice=lattice,
        cell_area=cell_area,
        overhang=overhang,
        sole=foot,
        border=border,
        lattice_cells=None,
        notes=(note,),
        blind_most=BLIND_MOST,
    )
