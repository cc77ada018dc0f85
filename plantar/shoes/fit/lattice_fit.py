"""Fit of a taxel lattice to a sole: place and turn. In mm."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError, InputError
from plantar.shoes.fit.cell_pattern import CellPattern, Lattice, hex_pattern

CELL_AREAS = (100.0, 5000.0)  # cell areas in mm^2 that are taken

# degrees between the lattice angles that are looked at; of cells with a tail
_ANGLE_STEP = 5
_TAILED_STEP = 15
_LONG_EDGE = 0.1  # of the outline's length
_MOST_EDGE_ANGLES = 6
_DECIMALS = 4  # of a placement in mm
_COARSE = 12  # sampled offsets along each axis of the lattice's unit cell
_OVERHANG_STEP = 0.5  # mm
_KEPT = 40  # placements compared at each angle and number of cells
_ROUNDING = 1e-4  # mm: an offset is rounded by less
_SLACK = 1e-3  # mm by which a cell may leave the region; above the rounding of a placement


@dataclass(frozen=True)
class LatticeFit:
    """Placed lattice and its kept cells.

    `cells`: axial coordinates (n, 2), row by row; `overhang`: used cell reach beyond the outline in mm.
    """

    lattice: Lattice
    cells: NDArray[np.int64]
    overhang: float


@dataclass(frozen=True)
class _Candidate:
    lattice: Lattice
    cells: NDArray[np.int64]
    covered: float
    spread: float
    rank: int
    straight: bool
    off_centre: float

    @property
    def score(self) -> tuple[float, ...]:
        return (float(self.straight), round(self.covered + self.spread, 1), -self.rank, -round(self.off_centre, 3))


def whole_cell_region(region: Any, parts: Sequence[NDArray[np.float64]], angle: float) -> Any:
    """Where a cell's centre may lie with the cell inside a region (erosion), to a micrometre.

    `region`: Shapely, in mm; `parts`: corners (k, 2) in mm of the cell's convex parts; `angle`: cell rotation in rad.
    Returns Shapely geometry, possibly empty.

    Example:
        >>> import shapely
        >>> parts = hex_pattern(1.5 * 3**0.5).parts
        >>> bool(abs(whole_cell_region(shapely.box(0, 0, 10, 10), parts, 0.0).area - (10 - 3**0.5) * 8) < 0.1)
        True
    """
    c = math.cos(angle)
    s = math.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    region = region.buffer(_SLACK, join_style="mitre")
    swept = [_swept(np.array(region.exterior.coords), part @ turn) for part in parts]
    return region.difference(shapely.union_all([hull for hulls in swept for hull in hulls]))


def _swept(points: NDArray[np.float64], part: NDArray[np.float64]) -> Any:
    swept = np.concatenate([points[:-1, None] - part, points[1:, None] - part], axis=1)
    return shapely.convex_hull(shapely.multipoints(swept))


def fit_lattice(
    sole: Any,
    *,
    cell_area: float = 691.0,
    taxels: int | None = None,
    overhang: float = 0.0,
    overhang_max: float = 0.0,
    pattern: CellPattern | None = None,
) -> LatticeFit:
    """Place the lattice with most whole cells inside a sole; deterministic.

    At every fifth degree (fifteenth for cells with a tail), and along long edges, the best offset is found exactly.
    Ties: straight rows, area under the cells and inside their hull, distance from the sole's centre.

    `sole`: Shapely outline in mm; `cell_area` in mm^2; `taxels`: their number, with the least overhang in steps of 0.5
    mm; None takes as many as fit; `overhang`: allowed cell reach beyond the outline in mm without `taxels`; the least
    with them; `overhang_max` in mm, with `taxels`; `pattern`: other cells than hexagons, for `cell_area`.
    """
    low, high = CELL_AREAS
    if pattern is None and not (math.isfinite(cell_area) and low <= cell_area <= high):
        raise InputError(f"cell area is {cell_area} mm^2; allowed: {low:g} to {high:g} mm^2")
    if taxels is not None and taxels < 1:
        raise InputError(f"number of taxels is {taxels}; allowed: 1 or more")
    if not (math.isfinite(overhang) and 0.0 <= overhang <= max(overhang, overhang_max)):
        raise InputError(f"overhang is {overhang} mm; allowed: 0 or more")
    pattern = pattern or hex_pattern(cell_area)
    if taxels is None:
        scans = _Scans(sole, pattern, overhang)
    else:
        scans = _least_overhang(sole, pattern, taxels, overhang, overhang_max)
        overhang = scans.overhang
    region = sole.buffer(overhang) if overhang > 0.0 else sole
    placements = _placements(sole, pattern, taxels, scans.all())
    if not placements:
        raise FootError(
            f"no whole cell of {pattern.area:g} mm^2 fits the sole ({sole.area:.0f} mm^2); use a smaller cell area, "
            f"{low:g} mm^2 or more"
        )
    best = max(placements, key=lambda p: p.score)
    best = _centred(best, sole, region, pattern)
    return LatticeFit(best.lattice, best.cells, overhang)


@dataclass(frozen=True)
class _Scan:
    """Whole cells at many lattice origins, one angle."""

    rank: int
    straight: bool
    angle: float
    allowed: Any
    offsets: NDArray[np.float64]
    counts: NDArray[np.int64]


class _Scans:
    """Scans of all angles with one overhang, each made once and only when asked for: one may show enough."""

    def __init__(self, sole: Any, pattern: CellPattern, overhang: float) -> None:
        self.overhang = overhang
        self._made: list[_Scan] = []
        self._others = _scan(sole, pattern, overhang)

    def hold(self, taxels: int) -> bool:
        """Whether some placement holds so many whole cells."""
        if _most(self._made) >= taxels:
            return True
        for scan in self._others:
            self._made.append(scan)
            if _most([scan]) >= taxels:
                return True
        return False

    def all(self) -> list[_Scan]:
        """Scan of each angle, in the order of ties."""
        self._made.extend(self._others)
        return self._made


def _least_overhang(sole: Any, pattern: CellPattern, taxels: int, overhang: float, overhang_max: float) -> _Scans:
    """Scans at the least overhang that holds `taxels`."""
    steps = max(0, math.floor((overhang_max - overhang) / _OVERHANG_STEP + 1e-9))

    def at(step: int) -> _Scans:
        return _Scans(sole, pattern, overhang + step * _OVERHANG_STEP)

    best = at(0)
    if best.hold(taxels):
        return best
    if steps:
        best = at(steps)
    if not best.hold(taxels):
        raise FootError(
            f"{taxels} taxels of {pattern.area:g} mm^2 do not fit: {_most(best.all())} do with cells up to "
            f"{overhang + steps * _OVERHANG_STEP:g} mm beyond the sole; ask for fewer or use a smaller cell area"
        )
    # low does not hold enough, high does
    low = 0
    high = steps
    while high - low > 1:
        middle = (low + high) // 2
        scans = at(middle)
        if scans.hold(taxels):
            high = middle
            best = scans
        else:
            low = middle
    return best


def _scan(sole: Any, pattern: CellPattern, overhang: float) -> Iterator[_Scan]:
    region = sole.buffer(overhang) if overhang > 0.0 else sole
    straight = len(_straight(pattern))
    for rank, angle in enumerate([*np.radians(_angles(pattern)), *_edge_angles(sole, pattern)]):
        allowed = whole_cell_region(region, pattern.parts, float(angle))
        if allowed.is_empty:
            continue
        lattice = pattern.at((0.0, 0.0), float(angle))
        offsets = np.concatenate([_sampled_offsets(pattern, angle), _critical_offsets(allowed, pattern, lattice)])
        allowed = allowed.buffer(_ROUNDING, join_style="mitre")  # the offsets lie on its border
        shapely.prepare(allowed)
        yield _Scan(rank, rank < straight, lattice.angle, allowed, offsets, _count(allowed, lattice, offsets))


def _straight(pattern: CellPattern) -> list[float]:
    return list(dict.fromkeys(k * 90.0 % float(round(math.degrees(pattern.period))) for k in range(4)))


def _angles(pattern: CellPattern) -> list[float]:
    """In degrees, in tie order: straight, halves between, then every step."""
    period = round(math.degrees(pattern.period))
    steps = [float(a) for a in range(0, period, _TAILED_STEP if period == 360 else _ANGLE_STEP)]
    straight = _straight(pattern)
    return list(dict.fromkeys([*straight, *(a for a in steps if a % 30.0 == 15.0), *steps]))


def _edge_angles(sole: Any, pattern: CellPattern) -> list[float]:
    """In rad, longest edge first, without those of `_angles`."""
    period = float(round(math.degrees(pattern.period)))
    points = np.array(sole.exterior.coords)
    edge = np.diff(points, axis=0)
    length = np.hypot(*edge.T)
    out: list[float] = []
    for i in np.argsort(-length, kind="stable"):
        if length[i] < _LONG_EDGE * length.sum() or len(out) >= _MOST_EDGE_ANGLES:
            break
        along = math.degrees(math.atan2(edge[i, 1], edge[i, 0]))
        for degrees in ((along + a) % period for a in _straight(pattern)):
            known = [*_angles(pattern), *np.degrees(out)]
            if min(min(abs(degrees - k), period - abs(degrees - k)) for k in known) > 1e-3:
                out.append(math.radians(degrees))
    return out


def _most(scans: list[_Scan]) -> int:
    return max((int(s.counts.max()) for s in scans), default=0)


def _placements(sole: Any, pattern: CellPattern, taxels: int | None, scans: list[_Scan]) -> list[_Candidate]:
    """Placements worth comparing: most whole cells, or the fewest that hold `taxels`, reduced to them."""
    most = _most(scans)
    if not most:
        return []
    if taxels is not None:  # a placement that holds just so many needs no gap in its rim
        most = min(int(s.counts[s.counts >= taxels].min(initial=most)) for s in scans)
    out = []
    for scan in scans:
        best = np.flatnonzero(scan.counts == most)
        for i in best[np.unique(np.linspace(0, len(best) - 1, _KEPT).astype(int))] if len(best) else ():
            x, y = scan.offsets[i]
            lattice = pattern.at((float(x), float(y)), scan.angle)
            cells = _cells_inside(scan.allowed, lattice, pattern)
            if taxels is not None:
                cells = _reduced(sole, lattice, cells, taxels)
            out.append(_candidate(sole, lattice, cells, scan.rank, scan.straight))
    return out


def _sampled_offsets(pattern: CellPattern, angle: float) -> NDArray[np.float64]:
    share = np.arange(_COARSE) / _COARSE
    u, v = np.meshgrid(share * pattern.width, share * pattern.rise)
    c = math.cos(angle)
    s = math.sin(angle)
    return np.asarray(np.stack([c * u - s * v, s * u + c * v], axis=-1).reshape(-1, 2).round(_DECIMALS))


def _critical_offsets(allowed: Any, pattern: CellPattern, lattice: Lattice) -> NDArray[np.float64]:
    """Origins (k, 2) with a cell tight at a corner of the allowed area, or two at edges: one is best."""
    edge = allowed.boundary
    shifts = _difference_vectors(allowed, lattice)
    corners = shapely.get_coordinates(edge)
    moved = shapely.transform(
        np.repeat(edge, len(shifts)), lambda points: points + np.repeat(shifts, len(corners), axis=0)
    )
    points = np.concatenate([corners, shapely.get_coordinates(shapely.intersection(moved, edge))])
    # The same placement, moved by a lattice vector to the unit cell at the origin.
    c = math.cos(lattice.angle)
    s = math.sin(lattice.angle)
    u = c * points[:, 0] + s * points[:, 1]
    v = -s * points[:, 0] + c * points[:, 1]
    row = np.floor(v / pattern.rise)
    u = u - pattern.shift * row
    v = v - pattern.rise * row
    u = u - pattern.width * np.floor(u / pattern.width)
    return np.unique(np.column_stack([c * u - s * v, s * u + c * v]).round(_DECIMALS), axis=0)


def _difference_vectors(allowed: Any, lattice: Lattice) -> NDArray[np.float64]:
    """Lattice vectors (k, 2) between two cells, one of each opposite pair."""
    low, high = np.array(allowed.bounds).reshape(2, 2)
    cells = lattice.cells_near(low - high, high - low)
    cells = cells[(cells[:, 1] > 0) | ((cells[:, 1] == 0) & (cells[:, 0] > 0))]
    vectors = lattice.centres(cells)
    return np.asarray(vectors[(np.abs(vectors) <= high - low + _SLACK).all(axis=1)])


def _count(allowed: Any, lattice: Lattice, offsets: NDArray[np.float64]) -> NDArray[np.int64]:
    centres = _near_centres(allowed, lattice)[1]
    x = centres[None, :, 0] + offsets[:, None, 0]
    return np.asarray(shapely.contains_xy(allowed, x, centres[None, :, 1] + offsets[:, None, 1]).sum(axis=1))


def _near_centres(allowed: Any, lattice: Lattice) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    box = np.array(allowed.bounds).reshape(2, 2)
    cells = lattice.cells_near(box[0], box[1])
    return cells, lattice.centres(cells)


def _cells_inside(allowed: Any, lattice: Lattice, pattern: CellPattern) -> NDArray[np.int64]:
    cells, centres = _near_centres(allowed, pattern.at((0.0, 0.0), lattice.angle))
    inside = shapely.contains_xy(allowed, centres[:, 0] + lattice.origin[0], centres[:, 1] + lattice.origin[1])
    return np.asarray(cells[inside])


def _covered_of_cells(sole: Any, lattice: Lattice, cells: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.asarray(shapely.area(shapely.intersection(shapely.polygons(lattice.corners(cells)), sole)))


def _candidate(sole: Any, lattice: Lattice, cells: NDArray[np.int64], rank: int, straight: bool) -> _Candidate:
    covered = float(_covered_of_cells(sole, lattice, cells).sum())
    spread = float(shapely.MultiPoint(lattice.corners(cells).reshape(-1, 2)).convex_hull.intersection(sole).area)
    middle = lattice.centres(cells).mean(axis=0)
    off = float(np.hypot(middle[0] - sole.centroid.x, middle[1] - sole.centroid.y))
    return _Candidate(lattice, cells, covered, spread, rank, straight, off)


def _reduced(sole: Any, lattice: Lattice, cells: NDArray[np.int64], taxels: int) -> NDArray[np.int64]:
    covered = np.round(_covered_of_cells(sole, lattice, cells), 3)
    centres = lattice.centres(cells)
    far = np.round(np.hypot(centres[:, 0] - sole.centroid.x, centres[:, 1] - sole.centroid.y), 3)
    return np.asarray(cells[np.sort(np.lexsort((np.arange(len(far)), far, -covered))[:taxels])])


def _centred(start: _Candidate, sole: Any, region: Any, pattern: CellPattern) -> _Candidate:
    """Same cells moved to the sole's centre as far as the region allows."""
    allowed = whole_cell_region(region, pattern.parts, start.lattice.angle)
    shapely.prepare(allowed)
    best = start
    step = 1.6
    while step >= 0.05:
        moves = [(dx * step, dy * step) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]
        trials = []
        for dx, dy in moves:
            x = round(best.lattice.origin[0] + dx, _DECIMALS)
            y = round(best.lattice.origin[1] + dy, _DECIMALS)
            lattice = pattern.at((x, y), best.lattice.angle)
            centres = lattice.centres(best.cells)
            if shapely.contains_xy(allowed, centres[:, 0], centres[:, 1]).all():
                trials.append(_candidate(sole, lattice, best.cells, best.rank, best.straight))
        better = max(trials, key=lambda p: p.score, default=best)
        if better.score > best.score:
            best = better
        else:
            step /= 2
    return best
