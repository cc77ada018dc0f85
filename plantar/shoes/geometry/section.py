"""Plane sections of a closed surface, and wall thickness in them. In mm."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

_OPPOSITE = -0.9  # cosine between the normals of two faces that count as the sides of one wall
_SPACING = 3.0  # mm between two measurements along a wall

Array = NDArray[np.float64]
Bands = tuple[tuple[float, float], ...]


def cut_segments(triangles: Array, height: float) -> tuple[Array, Array]:
    """Gives segments (m, 2, 2) where triangles (n, 3, 3) cross a height without corners, and outward unit normals (m,
    3).
    """
    above = triangles[..., 2] > height
    crossing = triangles[above.any(axis=1) & ~above.all(axis=1)]
    ends = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        a = crossing[:, i]
        b = crossing[:, j]
        crosses = (a[:, 2] > height) != (b[:, 2] > height)
        # From below to above, so that both triangles of an edge have the same point to the last bit: of two that
        # differ, rounding would leave a gap, and a section with a gap loses its holes.
        up = (b[:, 2] > height)[:, None]
        low = np.where(up, a, b)
        high = np.where(up, b, a)
        rise = np.where(crosses, high[:, 2] - low[:, 2], 1.0)
        point = low[:, :2] + ((height - low[:, 2]) / rise)[:, None] * (high - low)[:, :2]
        ends.append(np.where(crosses[:, None], point, np.nan))
    pairs = np.stack(ends, axis=1)  # each triangle has two of three points
    segments = pairs[np.isfinite(pairs[..., 0])].reshape(-1, 2, 2).round(4)
    normal = np.cross(crossing[:, 1] - crossing[:, 0], crossing[:, 2] - crossing[:, 0])
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    long = (segments[:, 0] != segments[:, 1]).any(axis=1)
    return segments[long], normal[long]


def section(triangles: Array, height: float) -> Any:
    """Gives shapely section of closed triangles (n, 3, 3) at a height in mm without corners."""
    segments, _ = cut_segments(triangles, height)
    return shapely.build_area(shapely.union_all(shapely.linestrings(segments))) if len(segments) else shapely.Polygon()


def section_along(triangles: Array, axis: int, at: float) -> Any:
    """Gives section of closed triangles (n, 3, 3) at x (axis 0) or y (axis 1), at a place in mm: shapely, over (y, z)
    or (x, z).
    """
    return section(triangles[..., [1, 2, 0] if axis == 0 else [0, 2, 1]], at)


def wall_thickness(segments: Array, outwards: Array, leave_out: tuple[int, Bands] | None = None) -> float:
    """Gives smallest thickness in mm between opposite faces: segments (m, 2, 2) of a section's border, outwards their
    unit normals (m, 3), leave_out an axis and unmeasured bands; infinite without segments.

    Example:
        >>> square = np.array([[[0, 0], [3, 0]], [[3, 0], [3, 9]], [[3, 9], [0, 9]], [[0, 9], [0, 0]]], dtype=float)
        >>> wall_thickness(square, np.array([[0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0]], dtype=float))
        3.0
    """
    length = np.hypot(*(segments[:, 1] - segments[:, 0]).T)
    keep = length > 1e-3
    segments = segments[keep]
    length = length[keep]
    outwards = outwards[keep]
    if not len(segments):
        return math.inf
    along = (segments[:, 1] - segments[:, 0]) / length[:, None]
    normal = np.column_stack([along[:, 1], -along[:, 0]])
    normal *= np.where(np.einsum("ij,ij->i", normal, outwards[:, :2]) < 0.0, -1.0, 1.0)[:, None]
    count = np.maximum(1, np.ceil(length / _SPACING)).astype(int)
    which = np.repeat(np.arange(len(segments)), count)
    place = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    share = (place + 0.5) / count[which]
    start = segments[which, 0] + share[:, None] * (segments[which, 1] - segments[which, 0])
    if leave_out is not None:
        at = start[:, leave_out[0]]
        measured = ~np.any([(at > low) & (at < high) for low, high in leave_out[1]], axis=0)
        start = start[measured]
        which = which[measured]
    thinnest = math.inf
    step = max(1, 4_000_000 // len(segments))
    for i in range(0, len(start), step):
        part = slice(i, i + step)
        way, first = _first_met(start[part], -normal[which[part]], segments, along, normal, length)
        opposite = np.einsum("ij,ij->i", outwards[which[part]], outwards[first]) < _OPPOSITE
        thinnest = min(thinnest, float(np.min(way, initial=math.inf, where=opposite)))
    return thinnest


def _first_met(
    start: Array, inwards: Array, segments: Array, along: Array, normal: Array, length: Array
) -> tuple[Array, NDArray[np.int64]]:
    """Distance from each start inwards to the first segment met, or infinity, and its number."""
    facing = inwards @ normal.T  # > 0: the ray leaves the solid there
    offset = segments[None, :, 0] - start[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        way = np.einsum("sij,ij->si", offset, normal) / facing
        at = np.einsum("sij,ij->si", way[..., None] * inwards[:, None] - offset, along)
    meets = (np.abs(facing) > 1e-9) & (way > 1e-6) & (at >= -1e-6) & (at <= length + 1e-6)
    way = np.where(meets, way, np.inf)
    first = way.argmin(axis=1)
    return way[np.arange(len(start)), first], first


def thinnest_wall(triangles: Array, engraved: Bands = ()) -> float:
    """Gives thinnest wall, floor or bar in mm of closed triangles (n, 3, 3), in sections along all axes except engraved
    bands of z.
    """
    thinnest = math.inf
    for order, count in (((0, 1, 2), None), ((1, 2, 0), 17), ((2, 0, 1), 13)):
        turned = triangles[..., order]
        upwards = order.index(2)
        for height in _heights(turned, count):
            if upwards == 2 and any(low < height < high for low, high in engraved):
                continue
            bands = (upwards, engraved) if upwards < 2 and engraved else None
            thinnest = min(thinnest, wall_thickness(*cut_segments(turned, height), bands))
    return thinnest


def _heights(triangles: Array, count: int | None) -> list[float]:
    z = triangles[..., 2]
    if count is not None:
        low = float(z.min())
        high = float(z.max())
        return [low + (high - low) * (i + 0.517) / count for i in range(count)]
    flat = np.unique(z[np.ptp(z, axis=1) < 1e-6].round(2))
    return [float(0.5 * (a + b)) + 1.7e-5 for a, b in pairwise(flat) if b - a > 0.15]
