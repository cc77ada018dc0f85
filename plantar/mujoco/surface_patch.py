"""Cells of a skin on the surface of a body: chosen by direction, region or drawn polygon, evenly spread."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.mujoco.geom_surface import GeomSurface

_SAMPLES = 8  # a cell's width in samples: areas are exact to some per cent, places to a sixteenth of a width
_MOST_CELLS = 4000
_ROUNDS = 40  # of moving cells to their middles; after 30 they move by less than a hundredth of their width
_TURNED = 0.6  # cell widths: how far apart two opposite sides are besides; keeps a cell on one side of a sheet
_SHIFTS = (0.2137, 0.3541, 0.4712)  # of the samples' lattice: no symmetric body has samples at equal distances
_STRIP = 0.35  # of a cell's width: a narrower region carries no row of cells
_BESIDE = 2.5e-6  # m: faces within half of it are one; `GeomSurface.contains` sees a micrometre
_TIE = 1e-10  # m: distances that differ by less are equal
_SLENDER = 25.0  # a region that is so many times longer than wide is a strip
_NEAR = 1.25  # cell widths: a contact reaches the cells next to its own


class Region(NamedTuple):
    """Which part of a surface: all conditions that are given hold; body frame.

    `outward`: direction (3,) that normals turn from by at most `within` in rad, or None; `axis`: direction (3,) from
    which normals turn by 45 degrees or more, either way, or None; `low`, `high`: corners (3,) of a box in m; `outline`:
    drawn polygon (m, 2) in m, empty for none; `across`: directions (2, 3) of its coordinates.
    """

    outward: NDArray[np.float64] | None
    within: float
    axis: NDArray[np.float64] | None
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    outline: NDArray[np.float64]
    across: NDArray[np.float64]

    def has(self, points: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether it has points (n, 3) with outward normals (n, 3)."""
        found = ((points >= self.low) & (points <= self.high)).all(axis=1)
        if self.outward is not None:
            found &= normals @ self.outward >= math.cos(self.within) - 1e-9
        if self.axis is not None:
            found &= np.abs(normals @ self.axis) <= math.sqrt(0.5) + 1e-9
        if len(self.outline):
            import shapely

            flat = points @ self.across.T
            found &= shapely.contains_xy(shapely.Polygon(self.outline), flat[:, 0], flat[:, 1])
        return np.asarray(found)


class SurfaceCells(NamedTuple):
    """n cells on a surface; body frame.

    `positions`: middles (n, 3) in m; `normals`: outward (n, 3); `areas` (n,) in m^2; `rings`: corners (k, 3) of each
    cell in its tangent plane; `neighbours` of each; `radius`: how far in m a contact reaches cells.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    areas: NDArray[np.float64]
    rings: list[NDArray[np.float64]]
    neighbours: tuple[tuple[int, ...], ...]
    radius: float


class Samples(NamedTuple):
    """Points (n, 3) all over a surface, their outward normals (n, 3), the area (n,) of each, and their pitch in m."""

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    areas: NDArray[np.float64]
    pitch: float

    def part(self, chosen: NDArray[np.bool_]) -> "Samples":
        return Samples(self.points[chosen], self.normals[chosen], self.areas[chosen], self.pitch)


def width_of(area: float) -> float:
    """Distance in m between the middles of regular hexagons of an area in m^2."""
    return math.sqrt(area * 2.0 / math.sqrt(3.0))


def sampled(surfaces: Sequence[GeomSurface], pitch: float, mirrored: bool) -> Samples:
    """Sample a body's surface: lines of a lattice along each axis, where the normal is nearest that axis.

    A point's area is pitch^2 / |cos| of its normal to the line; what lies inside of another geom, or between two that
    touch, is left out, and a face that several geoms share is sampled once. With
    `mirrored` the lattice is that of a body mirrored in y, so that its points are mirrored.
    """
    flip = np.array([1.0, -1.0 if mirrored else 1.0, 1.0])
    points = []
    normals = []
    areas = []
    for k, surface in enumerate(surfaces):
        low, high = surface.bounds()
        if mirrored:
            ends = np.array([low, high]) * flip
            low = ends.min(axis=0)
            high = ends.max(axis=0)
        for axis in range(3):
            first = (axis + 1) % 3
            second = (axis + 2) % 3
            ticks = [
                (np.arange(math.floor(low[j] / pitch) - 1, math.ceil(high[j] / pitch) + 1) + _SHIFTS[j]) * pitch
                for j in (first, second)
            ]
            starts = np.zeros((len(ticks[0]) * len(ticks[1]), 3))
            starts[:, first] = np.repeat(ticks[0], len(ticks[1]))
            starts[:, second] = np.tile(ticks[1], len(ticks[0]))
            way = np.eye(3)[axis]
            _, at, out = surface.crossings(starts * flip, way * flip)
            steep = np.abs(out)
            most = steep.max(axis=1, initial=0.0)
            own = np.argmax(steep >= most[:, None] - 1e-9, axis=1) == axis
            for j, other in enumerate(surfaces):
                if j != k:
                    _leave_out(own, at, out, other, others_first=j < k)
            points.append(at[own])
            normals.append(out[own])
            areas.append(pitch * pitch / steep[own, axis])
    return Samples(np.vstack(points), np.vstack(normals), np.concatenate(areas), pitch)


def _leave_out(
    own: NDArray[np.bool_], at: NDArray[np.float64], out: NDArray[np.float64], other: GeomSurface, others_first: bool
) -> None:
    """Take from `own` (n,) the points `at` (n, 3), normals `out` (n, 3), that are no surface beside an `other` geom.

    What geoms have in common is no surface where they face each other, and one surface, of the first of them, where
    they face one way.
    """
    low, high = other.bounds()
    seen = np.flatnonzero(own & (at > low - _BESIDE).all(axis=1) & (at < high + _BESIDE).all(axis=1))
    if not len(seen):
        return
    places = at[seen]
    aside = _BESIDE * out[seen]
    hidden = other.contains(places) | other.contains(places + aside)
    if others_first:
        hidden |= other.contains(places - aside)
    own[seen[hidden]] = False


def spread_cells(samples: Samples, area: float, where: str) -> SurfaceCells:
    """Cells of about an `area` in m^2 over samples: farthest points first, then each moved to its cell's middle.

    `where` begins an error's line. RobotError: a strip, or too many.
    """
    total = float(samples.areas.sum())
    width = width_of(area)
    count = max(1, round(total / area))
    if count > _MOST_CELLS:
        raise RobotError(f"{where} would have {count} cells; allowed: {_MOST_CELLS}; give a larger cell_area")
    refuse_strip(*_extents(samples), width, where)
    features = np.hstack([samples.points, _TURNED * 0.5 * width * samples.normals])
    seeds = _farthest(features, count, samples.areas)
    middles = features[seeds]
    owner = np.zeros(len(features), dtype=np.int64)
    for _ in range(_ROUNDS):
        owner = _nearest(middles, features)
        weight = np.bincount(owner, samples.areas, count)
        sums = np.column_stack([np.bincount(owner, samples.areas * column, count) for column in features.T])
        moved = np.where(weight[:, None] > 0.0, sums / np.maximum(weight, 1e-300)[:, None], middles)
        still = float(np.abs(moved - middles).max()) < 1e-4 * width
        middles = moved
        if still:
            break
    return _cells(samples, _nearest(middles, features), width)


def _cells(samples: Samples, owner: NDArray[np.int64], width: float) -> SurfaceCells:
    import shapely
    from scipy.spatial import cKDTree

    used = np.unique(owner)
    positions = []
    normals = []
    areas = []
    rings = []
    for cell in used.tolist():
        own = owner == cell
        points = samples.points[own]
        weights = samples.areas[own]
        middle = weights @ points / weights.sum()
        out = weights @ samples.normals[own]
        out /= np.linalg.norm(out)
        nearest = int(np.argmin(np.linalg.norm(points - middle, axis=1)))
        flat = samples.normals[own][nearest]
        positions.append(middle + flat * float((points[nearest] - middle) @ flat))
        normals.append(out)
        areas.append(float(weights.sum()))
        first = _across(out)
        second = np.cross(out, first)
        local = points - positions[-1]
        hull = shapely.MultiPoint(np.column_stack([local @ first, local @ second])).convex_hull
        seen = hull.buffer(0.5 * samples.pitch, quad_segs=1).simplify(0.2 * samples.pitch)
        ring = shapely.get_coordinates(shapely.orient_polygons(seen))[:-1]
        rings.append(positions[-1] + ring[:, :1] * first + ring[:, 1:] * second)
    numbers = np.searchsorted(used, owner)
    near = cKDTree(samples.points).query_pairs(1.8 * samples.pitch, output_type="ndarray")
    pairs = np.unique(np.sort(numbers[near], axis=1), axis=0)
    beside: list[set[int]] = [set() for _ in used]
    for a, b in pairs.tolist():
        if a != b:
            beside[a].add(b)
            beside[b].add(a)
    neighbours = tuple(tuple(sorted(n)) for n in beside)
    return SurfaceCells(np.array(positions), np.array(normals), np.array(areas), rings, neighbours, _NEAR * width)


def _nearest(middles: NDArray[np.float64], features: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of the nearest middle of each sample; the lower of two that are equally far, but for rounding."""
    from scipy.spatial import cKDTree

    if len(middles) == 1:
        return np.zeros(len(features), dtype=np.int64)
    away, which = cKDTree(middles).query(features, k=2)
    return np.asarray(np.where(away[:, 1] - away[:, 0] < _TIE, which.min(axis=1), which[:, 0]))


def _farthest(features: NDArray[np.float64], count: int, weights: NDArray[np.float64]) -> NDArray[np.int64]:
    """Samples that are as far from each other as can be, one after the other."""
    middle = weights @ features / weights.sum()
    chosen = np.empty(count, dtype=np.int64)
    chosen[0] = int(np.argmin(np.linalg.norm(features - middle, axis=1)))
    least = np.full(len(features), math.inf)
    # Samples of a flat face are in rows, and often equally far: a little more for some decides, not rounding.
    favour = 1.0 + 1e-6 * np.random.default_rng(0).random(len(features))
    for i in range(1, count):
        np.minimum(least, ((features - features[chosen[i - 1]]) ** 2).sum(axis=1), out=least)
        chosen[i] = int(np.argmax(least * favour))
    return chosen


def refuse_strip(long: float, thin: float, width: float, where: str) -> None:
    """RobotError if a region, `long` and `thin` in m, is too narrow for cells of a `width` in m, or for its length."""
    least = max(_STRIP * width, long / _SLENDER)
    if thin < least:
        raise RobotError(
            f"{where} is a strip of {1e3 * thin:.1f} mm; allowed: {1e3 * least:.1f} mm or more; "
            "give a smaller cell_area, or another direction or region"
        )


def _extents(samples: Samples) -> tuple[float, float]:
    """Length and width in m of an even rectangle that spreads as the samples do."""
    if len(samples.points) < 2:
        return samples.pitch, samples.pitch
    middle = samples.areas @ samples.points / samples.areas.sum()
    away = samples.points - middle
    spread = np.sqrt(12.0 * np.maximum(np.linalg.eigvalsh((away.T * samples.areas) @ away / samples.areas.sum()), 0.0))
    return float(spread[2]), float(spread[1]) + samples.pitch


def _across(normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """A unit vector (3,) across a normal."""
    first = np.cross(normal, [0.0, 0.0, 1.0] if abs(normal[2]) < 0.9 else [1.0, 0.0, 0.0])
    return np.asarray(first / np.linalg.norm(first))
