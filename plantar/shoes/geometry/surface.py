"""Surfaces of up to a million triangles on a micrometre grid: closure, cover, hull."""

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.optional_library import optional_library
from plantar.errors import FootError

_GRID = 1e-3  # mm
_MOST_EDGES = 60_000  # left over: more come of triangles that do not join
_MOST_CROSSED = 40_000_000  # edges times faces that they enclose
_SQUARE = 1.0  # mm
_MOST_TIMES = 40.0  # that triangles cover an area over each other
_DIRECTIONS = 32  # in which points are sought that lie farthest out
_FEW = 2000  # points whose hull is found at once

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


def corner_numbers(points: Array) -> Numbers:
    """Number for each point (..., 2) or (..., 3) in mm, equal at one grid place.

    Example:
        >>> corner_numbers(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1e-6]])).tolist()
        [0, 1, 0]
    """
    shape = points.shape[:-1]
    places = np.rint(points.reshape(-1, points.shape[-1]) / _GRID).astype(np.int64)
    number: Numbers = np.zeros(len(places), dtype=np.int64)
    for i in range(places.shape[1]):
        axis = places[:, i] - places[:, i].min(initial=0)
        span = int(axis.max(initial=0)) + 1
        if int(number.max(initial=0)) > np.iinfo(np.int64).max // (2 * span):
            number = np.unique(number, return_inverse=True)[1].reshape(-1)
        number = number * span + axis
    return np.unique(number, return_inverse=True)[1].reshape(shape)


def thinned(points: Array, spacing: float) -> Array:
    """Gives first of points (n, 2) or (n, 3) in each grid cell of a spacing in their unit."""
    _, first = np.unique(corner_numbers(points * (_GRID / spacing)), return_index=True)
    return np.asarray(points[first])


def is_closed(triangles: Array) -> bool:
    """Whether every edge of triangles (n, 3, 3) in mm is in exactly two."""
    corners = corner_numbers(triangles)
    start = corners.ravel()
    end = np.roll(corners, -1, axis=1).ravel()
    long = start != end
    key = np.minimum(start, end)[long] * (int(corners.max(initial=0)) + 1) + np.maximum(start, end)[long]
    return bool((np.unique(key, return_counts=True)[1] == 2).all())


def convex_outline(points: Array) -> Any:
    """Shapely convex hull of points (n, 2) in mm; inner points are left out first."""
    if len(points) > _FEW:
        x = np.ascontiguousarray(points[:, 0])
        y = np.ascontiguousarray(points[:, 1])
        extreme: list[int] = []
        for turn in np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS:
            along = np.cos(turn) * x + np.sin(turn) * y
            extreme += [int(along.argmin()), int(along.argmax())]
        spanned = shapely.MultiPoint(points[extreme]).convex_hull
        if spanned.geom_type == "Polygon":
            shapely.prepare(spanned)
            outside = np.unique((x + 1j * y)[~shapely.contains_xy(spanned, x, y)])
            points = np.column_stack([outside.real, outside.imag])
    return shapely.MultiPoint(points).convex_hull


def covered_area(flat: Array) -> Any:
    """Shapely cover of triangles (n, 3, 2) in mm, in any order and direction."""
    flat = np.rint(flat / _GRID) * _GRID
    u = flat[:, 1] - flat[:, 0]
    v = flat[:, 2] - flat[:, 0]
    double = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    flat = np.where((double < 0.0)[:, None, None], flat[:, ::-1], flat)[np.abs(double) > 0.1 * _GRID**2]
    if not len(flat):
        return shapely.Polygon()
    edges, times = _left_over(flat)
    if len(edges) > _MOST_EDGES:
        return _united(flat)
    lines = shapely.linestrings(edges)
    faces = shapely.get_parts(shapely.polygonize([shapely.union_all(lines, grid_size=_GRID)]))
    if len(faces) * len(edges) > _MOST_CROSSED:
        return _united(flat)
    inside = _winding(shapely.get_coordinates(shapely.point_on_surface(faces)), edges, times) > 0
    return shapely.union_all(faces[inside])


def _united(flat: Array) -> Any:
    """Cover of unjoined triangles (n, 3, 2); holes under a millimetre count as covered."""
    parts = shapely.polygons(np.concatenate([flat, flat[:, :1]], axis=1))
    if shapely.area(parts).sum() > _MOST_TIMES * convex_outline(flat.reshape(-1, 2)).area:
        raise FootError("its triangles overlap without joining; give a surface")
    low = flat.min(axis=(0, 1)) - 4.0 * _SQUARE
    size = tuple(((flat.max(axis=(0, 1)) - low) / _SQUARE + 5.0).astype(int))
    met = np.zeros(size, dtype=bool)
    points = surface_points(np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2), 0.5 * _SQUARE)[:, :2]
    met[tuple(((points - low) / _SQUARE).astype(int).T)] = True
    inner = met.copy()
    for i in range(-2, 3):
        for j in range(-2, 3):
            inner &= np.roll(met, (i, j), axis=(0, 1))
    corners = low + _SQUARE * np.argwhere(inner)
    middle = shapely.union_all(shapely.box(*corners.T, *(corners + _SQUARE).T)) if len(corners) else shapely.Polygon()
    shapely.prepare(middle)
    parts = parts[~shapely.covers(middle, parts)]
    return shapely.union_all([middle, *parts], grid_size=_GRID)


def _left_over(flat: Array) -> tuple[Array, Numbers]:
    """Directed triangle edges (m, 2, 2) that no others cancel, and each one's count."""
    corners = corner_numbers(flat)
    start = corners.ravel()
    end = np.roll(corners, -1, axis=1).ravel()
    count = int(corners.max()) + 1
    key = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    net = np.add.reduceat(np.where(start < end, 1, -1)[order], first)
    left = np.flatnonzero(net)
    which = order[first[left]]
    points = flat.reshape(-1, 2)
    edges = np.stack([points[which], points[3 * (which // 3) + (which + 1) % 3]], axis=1)
    turned = (start[which] < end[which]) != (net[left] > 0)
    return np.where(turned[:, None, None], edges[:, ::-1], edges), np.abs(net[left])


def _winding(points: Array, edges: Array, times: Numbers) -> Numbers:
    """Winding number (k,) of directed edges (m, 2, 2) about points (k, 2)."""
    out = np.zeros(len(points), dtype=np.int64)
    ax, ay = edges[:, 0].T
    bx, by = edges[:, 1].T
    step = max(1, 4_000_000 // len(edges))
    for i in range(0, len(points), step):
        x = points[i : i + step, :1]
        y = points[i : i + step, 1:]
        side = (bx - ax) * (y - ay) - (by - ay) * (x - ax)  # > 0: the point lies left of the edge
        up = (ay <= y) & (by > y) & (side > 0.0)
        down = (ay > y) & (by <= y) & (side < 0.0)
        out[i : i + step] = ((up.astype(np.int64) - down) * times).sum(axis=1)
    return out


def surface_points(triangles: Array, spacing: float) -> Array:
    """Gives points (n, 3) all over triangles (k, 3, 3), about `spacing` apart, corners included."""
    size = np.linalg.norm(np.stack([triangles[:, i] - triangles[:, i - 1] for i in range(3)]), axis=-1).max(axis=0)
    steps = np.clip(np.ceil(size / spacing), 1, 120).astype(int)
    out = [triangles.reshape(-1, 3)]
    for count in np.unique(steps[steps > 1]):
        i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1))
        i, j = i[i + j <= count] / count, j[i + j <= count] / count
        a, b, c = np.moveaxis(triangles[steps == count], 1, 0)
        out.append((a[:, None] + i[:, None] * (b - a)[:, None] + j[:, None] * (c - a)[:, None]).reshape(-1, 3))
    return np.concatenate(out)


_SIZES = {"box": 3, "sphere": 1, "cylinder": 2, "capsule": 2, "ellipsoid": 3}


def primitive(kind: str, size: NDArray[np.float64], where: str) -> NDArray[np.float64]:
    """Gives triangles (n, 3, 3) of a "box", "sphere", "cylinder", "capsule" or "ellipsoid" (kind) about the origin,
    axis z, of a size as in MJCF; where is for messages.
    """
    if kind not in _SIZES:
        raise FootError(f"{where}: '{kind}' is no shape that is read; allowed: mesh, {', '.join(_SIZES)}")
    count = _SIZES[kind]
    if len(size) < count or not (size[:count] > 0.0).all():
        raise FootError(f"{where}: a {kind} needs {count} sizes above 0")
    with optional_library("trimesh", "shoes"):
        from trimesh import creation
    if kind == "box":
        mesh = creation.box(extents=2.0 * size[:3])
    elif kind == "cylinder":
        mesh = creation.cylinder(radius=size[0], height=2.0 * size[1], sections=48)
    elif kind == "capsule":
        mesh = creation.capsule(radius=size[0], height=2.0 * size[1], count=[24, 24])
        mesh.vertices[:, 2] -= 0.5 * (mesh.vertices[:, 2].max() + mesh.vertices[:, 2].min())
    else:
        mesh = creation.icosphere(subdivisions=3)
        mesh.vertices *= size[:3] if kind == "ellipsoid" else size[0]
    return np.asarray(np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.faces)])
