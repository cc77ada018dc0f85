"""Sole plane outlines in mm: shapely, counter-clockwise, without holes, on a micrometre grid."""

import math
from bisect import bisect_right
from collections.abc import Callable
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.geometry.surface import convex_outline, covered_area

GRID = 1e-3  # grid in mm that polygon corners lie on
CORNER = 1.2  # how much farther than its edges the corner of a grown outline may lie
_SIMPLIFY = 0.04  # mm of detail that is dropped; less than what the gap between foot and wall may lack
_GROOVE = 10.0  # mm: half the width of a groove that is bridged
_NEARLY_CONVEX = 0.9  # of the hull's area: above it the hull is the outline
_HAIR = 0.05  # mm: half the width of what lies between two outlines and is left out
_LEAST = 0.25  # mm between two corners
_BULGE = 0.1  # mm between a facet of a quarter circle and its arc
_BAND = 8000  # triangles whose part of an outline is found at once
_WITHIN = 0.02  # mm that a triangle may reach beyond those below it
_EMPTY = shapely.Polygon()
_EXACT = 1e-9  # mm: what lies nearer to a line lies on it


def tidy(polygon: Any) -> Any:
    """Polygon on the grid, counter-clockwise, without collinear points: largest part, holes filled."""
    shape = shapely.set_precision(polygon, GRID)
    parts = [p for p in getattr(shape, "geoms", [shape]) if p.geom_type == "Polygon" and not p.is_empty]
    if not parts:
        raise FootError("the outline has no area")
    largest = max(parts, key=lambda p: p.area)
    return shapely.geometry.polygon.orient(shapely.Polygon(largest.exterior).simplify(0.5 * GRID))


def grown(shape: Any, distance: float) -> Any:
    """Gives shapely shape with edges moved outwards by a distance in mm; corners at most CORNER times as far."""
    if distance <= 0.0:
        return shape
    out = shape.buffer(distance, join_style="mitre", mitre_limit=CORNER - 0.05)
    return _pointed(out) if out.geom_type == "Polygon" else out


def _pointed(polygon: Any) -> Any:
    points = ring(polygon)
    while (fewer := _with_fewer(points)) is not None:
        points = fewer
    return shapely.Polygon(points, polygon.interiors)


def _with_fewer(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Ring without one of its short edges; None where all stay."""
    short = np.hypot(*(np.roll(points, -1, axis=0) - points).T) < _LEAST
    tries = (_without_edge(np.roll(points, 1 - k, axis=0)) for k in np.flatnonzero(short).tolist() if len(points) > 4)
    return next((fewer for fewer in tries if fewer is not None), None)


def _without_edge(points: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Ring without its second edge: with one corner where those next to it meet, or without what lies on a line."""
    a, b, c, d = points[:4]
    u = b - a
    v = d - c
    across = u[0] * v[1] - u[1] * v[0]
    if abs(across) > 1e-9:
        point = a + ((c - a)[0] * v[1] - (c - a)[1] * v[0]) / across * u
        if np.hypot(*(point - 0.5 * (b + c))) < _LEAST:
            return np.vstack([a, point, points[3:]])
    off = [
        abs(way[0] * (q - start)[1] - way[1] * (q - start)[0]) / max(np.hypot(*way), _EXACT)
        for q, start, way in ((b, a, c - a), (c, b, d - b))
    ]
    return np.delete(points, 1 + int(off[1] < off[0]), axis=0) if min(off) < _SIMPLIFY else None


def ring(polygon: Any) -> NDArray[np.float64]:
    """Polygon corners (k, 2) in mm, counter-clockwise, last point not repeated."""
    corners = np.array(polygon.exterior.coords, dtype=float)[:-1, :2]
    return corners if polygon.exterior.is_ccw else corners[::-1].copy()


def apart(outer: Any, inner: Any) -> Any:
    """Gives an outer outline beyond an inner one, hair-wide parts left out, grown by a hair."""
    return outer.difference(inner).buffer(-_HAIR).buffer(2.0 * _HAIR, quad_segs=1)


def flush(outer: Any, inner: Any) -> Any:
    """Gives outer outline, shapely in mm, made identical to the enclosed inner one wherever both nearly agree.

    Walls a hair apart give zero-width faces, which the CAD kernel loses. Where the two part, the result is off the
    grid.

    Example:
        >>> import shapely
        >>> flush(shapely.box(-0.01, 0.0, 9.0, 4.0), shapely.box(0.0, 0.0, 5.0, 4.0)).bounds
        (0.0, 0.0, 9.0, 4.0)
    """
    joined = inner.union(apart(outer, inner).intersection(outer))
    largest = max(getattr(joined, "geoms", [joined]), key=lambda g: float(g.area))
    points = ring(shapely.geometry.polygon.orient(shapely.Polygon(largest.exterior)))
    beside = inner.exterior.distance(shapely.points(points))
    return joined_corners(shapely.Polygon(points[(beside < _EXACT) | (beside > _LEAST)]), inner)


def joined_corners(outline: Any, other: Any) -> Any:
    """Gives shapely outline in mm without one of corners that nearly coincide: other's stay, or those on its edges."""
    points = ring(outline)
    corners = set(map(tuple, ring(other).tolist()))
    along = other.exterior.distance(shapely.points(points)) < _EXACT
    rank = [2 if tuple(p) in corners else int(on) for p, on in zip(points.tolist(), along, strict=True)]
    kept: list[int] = []
    for i in range(len(points)):
        while kept and math.dist(points[i], points[kept[-1]]) < _LEAST and rank[kept[-1]] < rank[i]:
            kept.pop()
        if not kept or rank[i] == 2 or math.dist(points[i], points[kept[-1]]) >= _LEAST:
            kept.append(i)
    if math.dist(points[kept[0]], points[kept[-1]]) < _LEAST and min(rank[kept[0]], rank[kept[-1]]) < 2:
        kept.pop(0 if rank[kept[0]] < rank[kept[-1]] else -1)
    return shapely.Polygon(points[kept])


def gathered(points: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gives points (n, 2) in mm, those near one of corners (k, 2) moved there: no unmakeably short edges.

    Example:
        >>> gathered(np.array([[0.1, 0.0], [3.0, 0.0]]), np.array([[0.0, 0.0]])).tolist()
        [[0.0, 0.0], [3.0, 0.0]]
    """
    from scipy.spatial import cKDTree

    gaps, nearest = cKDTree(corners).query(points)
    return np.where((gaps < _LEAST)[:, None], corners[nearest], points)


def rounded_rectangle(length: float, width: float, centre: tuple[float, float], radius: float) -> Any:
    """Gives shapely rectangle of length (x) and width (y) about a centre, with corners of a radius, in mm.

    Example:
        >>> rounded_rectangle(200.0, 100.0, (20.0, 0.0), 10.0).bounds
        (-80.0, -50.0, 120.0, 50.0)
    """
    x, y = centre
    a = 0.5 * length - radius
    b = 0.5 * width - radius
    core = shapely.LineString([(x - a, y), (x + a, y)]) if b <= 0.0 < a else shapely.box(x - a, y - b, x + a, y + b)
    facets = max(8, math.ceil(math.pi / 4.0 / math.acos(max(0.0, 1.0 - _BULGE / radius)))) if radius > 0.0 else 0
    return tidy(core.buffer(radius, quad_segs=facets) if radius > 0.0 else core)


def outline_below(triangles: NDArray[np.float64], height: float) -> Any:
    """Gives outline of triangles (n, 3, 3) in mm, cut at a height above the sole plane, by `single_outline`."""
    return outline_of(cut_below(triangles, height), height)


def outlines_below(triangles: NDArray[np.float64]) -> Callable[[float], Any]:
    """Gives `outline_below` of triangles (n, 3, 3) in mm by height. A scan's are joined once, in bands from below,
    without what lies over lower ones, as most of a rough wall does.
    """
    if len(triangles) < 2 * _BAND:
        return lambda height: outline_below(triangles, height)
    low = triangles[..., 2].min(axis=1)
    high = triangles[..., 2].max(axis=1)
    order = np.argsort(low, kind="stable")
    bands: list[tuple[float, Any, NDArray[np.int64]]] = []  # height, outline below it, triangles that reach higher
    cover = _EMPTY
    near = order[:0]
    for band in np.array_split(order, len(order) // _BAND):
        start = float(low[band[0]])
        below = high[near] <= start
        joined = shapely.union(cover, covered_area(triangles[near[below], :, :2]), grid_size=GRID)
        cover = shapely.union_all([shapely.Polygon(p.exterior) for p in shapely.get_parts(joined) if p.area > 0.0])
        room = cover.buffer(_WITHIN, quad_segs=1)
        shapely.prepare(room)
        beyond = band[~shapely.covers(room, shapely.linearrings(triangles[band, :, :2]))]
        near = np.concatenate([near[~below], beyond])
        bands.append((start, cover, near))

    def outline(height: float) -> Any:
        _, lower, reaching = bands[max(bisect_right(bands, height, key=lambda band: band[0]) - 1, 0)]
        return outline_of(cut_below(triangles[reaching], height), height, lower)

    return outline


def outline_of(below: NDArray[np.float64], height: float, lower: Any = _EMPTY) -> Any:
    """Gives outline of triangles (n, 3, 3) in mm below a height in mm, by `single_outline`, and of a lower part's."""
    if len(below) == 0 and lower.is_empty:
        raise FootError(f"the mesh has no surface in its lowest {height:g} mm")
    points = convex_outline(np.concatenate([below.reshape(-1, 3)[:, :2], shapely.get_coordinates(lower)]))
    if points.geom_type != "Polygon" or points.area < 1.0:
        raise FootError(f"the lowest {height:g} mm of the mesh have no area: a point or an edge is no sole")
    # Vertical walls project to lines: they count in the hull, not in the union.
    return single_outline(shapely.union(_projected(below), lower), points)


def touching(triangles: NDArray[np.float64], height: float) -> Any:
    """Gives floor area, in parts and with holes, under triangles (n, 3, 3) below a height in mm."""
    return _projected(cut_below(triangles, height))


def _projected(triangles: NDArray[np.float64]) -> Any:
    return shapely.set_precision(covered_area(triangles[..., :2]), GRID)  # which closes hairline gaps


def single_outline(union: Any, hull: Any, *, detail: float = _SIMPLIFY) -> Any:
    """Gives one sole outline from the union of touching areas and their hull, shapely in mm; less than a detail in mm
    is dropped.

    Several patches, or a nearly convex shape, give the hull; one patch with a waist or notch keeps it, holes filled and
    grooves bridged.
    """
    filled = shapely.union_all([shapely.Polygon(p.exterior) for p in getattr(union, "geoms", [union]) if p.area > 1.0])
    bridged = filled.buffer(_GROOVE).buffer(-_GROOVE)
    one_patch = bridged.geom_type == "Polygon" and not bridged.is_empty
    if not one_patch or bridged.area >= _NEARLY_CONVEX * hull.area:
        return tidy(hull.simplify(detail).convex_hull)
    return tidy(shapely.Polygon(bridged.exterior).simplify(detail))


def cut_below(triangles: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    """Gives parts (m, 3, 3) of triangles (n, 3, 3) at or below a height z, all in mm."""
    inside = triangles[..., 2] <= height
    count = inside.sum(axis=1)
    out = [triangles[count == 3]]
    for kept in (1, 2):
        chosen = triangles[count == kept]
        if not len(chosen):
            continue
        # Turn each triangle so that its odd corner comes first.
        odd = np.argmax(inside[count == kept] == (kept == 1), axis=1)
        turned = chosen[np.arange(len(chosen))[:, None], (odd[:, None] + np.arange(3)) % 3]
        a = turned[:, 0]
        b = turned[:, 1]
        c = turned[:, 2]
        ab = a + ((height - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None] * (b - a)
        ac = a + ((height - a[:, 2]) / (c[:, 2] - a[:, 2]))[:, None] * (c - a)
        if kept == 1:
            out.append(np.stack([a, ab, ac], axis=1))
        else:
            out += [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    return np.concatenate(out)
