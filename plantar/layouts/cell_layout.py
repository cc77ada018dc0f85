"""Layouts of cells of any shape and size, or joined from parts."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, items, positive
from plantar.common.arrays import array, integers, is_finite, numbers
from plantar.common.plane_points import plane_points
from plantar.errors import InputError, LayoutError
from plantar.layouts.layout import Side, SoleLayout

_GRID = 1e-6  # of the smallest cell's side
_OVERLAP = 1e-3  # Share of the smaller cell that two cells may overlap by: rounding, not a fault


def layout_of_cells(
    cells: Sequence[ArrayLike],
    *,
    name: str = "sole",
    side: Side = "left",
    outline: ArrayLike | None = None,
    ids: Sequence[int] | None = None,
    cell_shape: str = "polygon",
    positions: ArrayLike | None = None,
    rotations: ArrayLike | None = None,
) -> SoleLayout:
    """A layout of polygonal cells of any shapes and sizes (T 4.5).

    Corners within a thousandth of a small cell's size become one vertex, also on edges: outlines are exact.

    Args:
        cells: Corners (k, 2) of each cell in sole frame in m, either orientation, not self-crossing.
        name: Name of sole.
        side: "left" or "right".
        outline: Outline (k, 2) in m; None for that of all cells, or their hull if in pieces.
        ids: Cell ids; None for 0, 1, ...
        cell_shape: One of `plantar.layouts.layout.CELL_SHAPES`.
        positions: Taxel centers (n, 2) in m; None for centroids.
        rotations: Rotations (n, 3, 3) from taxel frames to the sole's; None for level.

    Returns:
        The layout; its `cell_area` is the median.

    Raises:
        LayoutError: Invalid cells or fields.

    Example:
        >>> square = np.array([[0.0, 0.0], [0.02, 0.0], [0.02, 0.02], [0.0, 0.02]])
        >>> layout = layout_of_cells([square, 0.5 * square + [0.02, 0.0], 0.5 * square + [0.02, 0.01]])
        >>> layout.neighbours, len(layout.vertices), layout.areas.round(9).tolist()
        (((1, 2), (0, 2), (0, 1)), 8, [0.0004, 0.0001, 0.0001])
    """
    import shapely  # 0.2 s: only where a layout is made

    rings = [checked_ring(cell, f"cell {i}") for i, cell in enumerate(items(cells, "cells", LayoutError))]
    if not rings:
        raise LayoutError("a layout needs one cell or more")
    polygons = np.array([shapely.geometry.polygon.orient(shapely.Polygon(r)) for r in rings])
    for i in np.flatnonzero(~shapely.is_valid(polygons) | ~(shapely.area(polygons) > 0.0)):
        raise LayoutError(f"cell {i} is not a simple polygon: it crosses itself or has no area")
    _check_overlap(polygons)
    grain = 1e-3 * math.sqrt(float(shapely.area(polygons).min()))
    vertices, corners = shared_vertices([shapely.get_coordinates(p)[:-1] for p in polygons], tolerance=grain)
    if any(len(c) < 3 for c in corners):
        raise LayoutError(f"cell {min(i for i, c in enumerate(corners) if len(c) < 3)} has corners that coincide")
    corners = _with_touching_vertices(vertices, corners, grain)
    merged = [shapely.Polygon(vertices[list(c)]) for c in corners]
    centres = [p.centroid.coords[0] for p in polygons] if positions is None else positions
    centres = array(centres, "layout field 'positions'", (len(corners), 2), LayoutError)
    areas = shapely.area(polygons)  # as given: corners that become one move by up to a grain
    n = len(corners)
    turns = np.broadcast_to(np.eye(3), (n, 3, 3))
    if rotations is not None:
        turns = array(rotations, "layout field 'rotations'", (n, 3, 3), LayoutError)
    return SoleLayout(
        name=name,
        side=side,
        positions=np.column_stack([centres, np.zeros(n)]),
        rotations=turns,
        vertices=np.column_stack([vertices, np.zeros(len(vertices))]),
        corners=tuple(corners),
        neighbours=edge_neighbours(corners),
        areas=areas,
        outline=_outline_of(merged, grain) if outline is None else _ccw(outline),
        ids=np.arange(n) if ids is None else integers(ids, "layout field 'ids'", (n,), LayoutError),
        cell_shape=cell_shape,
        cell_area=float(np.median(areas)),
    )


def joined_layout(
    parts: Sequence[SoleLayout], *, name: str | None = None, outline: ArrayLike | None = None
) -> SoleLayout:
    """One layout of several flat ones, such as hexagons and squares.

    Args:
        parts: The layouts; their cells must not overlap.
        name: Name of sole; None for the first part's.
        outline: Outline (k, 2) in m, as in `layout_of_cells`.

    Returns:
        Cells in order with ids 0, 1, ...; quantities, ranges and thresholds of the first part.

    Raises:
        LayoutError: Parts do not fit.

    Example:
        >>> from plantar import grid_layout, hex_layout
        >>> heel = hex_layout([[-0.1, -0.05], [0, -0.05], [0, 0.05], [-0.1, 0.05]])
        >>> toes = grid_layout([[0, -0.05], [0.1, -0.05], [0.1, 0.05], [0, 0.05]], pitch=(0.01, 0.01))
        >>> sole = joined_layout([heel, toes])
        >>> sole.cell_shape, len(sole) == len(heel) + len(toes)
        ('mixed', True)
    """
    from dataclasses import replace

    parts = [instance(p, SoleLayout, "part of a layout", LayoutError) for p in items(parts, "parts", LayoutError)]
    if not parts:
        raise LayoutError("a layout is joined of one part or more")
    if len({p.side for p in parts}) > 1:
        raise LayoutError("parts of a layout are of both sides; expected one")
    if any(len(p.vertices) and np.abs(p.vertices[:, 2]).max() > 0.0 for p in parts):
        raise LayoutError("a part of a layout is curved; join flat parts, then lay them over the surface")
    shapes = {p.cell_shape for p in parts}
    joined = layout_of_cells(
        [p.cell_polygon(i) for p in parts for i in range(len(p))],
        name=parts[0].name if name is None else name,
        side=parts[0].side,
        outline=outline,
        cell_shape=shapes.pop() if len(shapes) == 1 else "mixed",
        positions=np.concatenate([p.positions[:, :2] for p in parts]),
        rotations=np.concatenate([p.rotations for p in parts]),
    )
    first = parts[0]
    return replace(joined, modalities=first.modalities, ranges=first.ranges, thresholds=first.thresholds)


def shared_vertices(rings: Sequence[ArrayLike], tolerance: float) -> tuple[NDArray[np.float64], list[tuple[int, ...]]]:
    """Give points of cell `rings` (k, 2) in m that agree within a `tolerance` in m one index.

    Returns points (v, 2) in m, and each cell's corner indices, none twice in a row; an InputError if invalid.
    """
    positive(tolerance, "tolerance of corners", "m")
    points: list[NDArray[np.float64]] = []
    index: dict[tuple[int, int], int] = {}
    corners: list[tuple[int, ...]] = []
    for ring in items(rings, "rings"):
        ids: list[int] = []
        for p in plane_points(ring, "ring"):
            kx = math.floor(p[0] / tolerance + 0.5)
            ky = math.floor(p[1] / tolerance + 0.5)
            hit = next(
                (index[k] for dx in (0, -1, 1) for dy in (0, -1, 1) if (k := (kx + dx, ky + dy)) in index),
                None,
            )
            if hit is None:
                hit = len(points)
                points.append(p)
                index[(kx, ky)] = hit
            if not ids or (hit != ids[-1] and hit != ids[0]):
                ids.append(hit)
        corners.append(tuple(ids))
    return np.array(points).reshape(-1, 2), corners


def edge_neighbours(corners: Sequence[Sequence[int]]) -> tuple[tuple[int, ...], ...]:
    """Each cell's increasing indices of those that share an edge, by vertex indices of each cell; an InputError if one
    is not a list of indices.
    """
    owners: dict[tuple[int, int], list[int]] = {}
    rows = [integers(ring, f"cell {i}", ("k",)).tolist() for i, ring in enumerate(items(corners, "cells"))]
    for i, ring in enumerate(rows):
        for a, b in zip(ring, [*ring[1:], ring[0]], strict=True):
            owners.setdefault((min(a, b), max(a, b)), []).append(i)
    near: list[set[int]] = [set() for _ in rows]
    for cells in owners.values():
        for a in cells:
            near[a].update(b for b in cells if b != a)
    return tuple(tuple(sorted(s)) for s in near)


def checked_ring(points: ArrayLike, what: str) -> NDArray[np.float64]:
    """Returns a polygon's `points` (n, 2), at least 3 and finite; `what` is its name in errors."""
    try:
        ring = numbers(points, what)
    except InputError as problem:
        raise LayoutError(f"{what} is not a list of (x, y) points ({problem})") from None
    if ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < 3 or not is_finite(ring):
        raise LayoutError(f"{what} is not a list of 3 or more finite (x, y) points")
    return ring


def _ccw(outline: ArrayLike) -> NDArray[np.float64]:
    import shapely

    polygon = shapely.Polygon(checked_ring(outline, "outline"))
    if not polygon.is_valid:
        raise LayoutError("outline is not a simple polygon: it crosses itself")
    return np.asarray(shapely.get_coordinates(shapely.geometry.polygon.orient(polygon))[:-1])


def _check_overlap(polygons: NDArray[np.object_]) -> None:
    import shapely

    one, other = shapely.STRtree(polygons).query(polygons, predicate="intersects")
    pairs = one < other
    one = one[pairs]
    other = other[pairs]
    # Without a grid GEOS may give a whole cell as what two have in common that touch along a part of an edge.
    grid = _GRID * math.sqrt(float(shapely.area(polygons).min()))
    common = shapely.area(shapely.intersection(polygons[one], polygons[other], grid_size=grid))
    smaller = np.minimum(shapely.area(polygons[one]), shapely.area(polygons[other]))
    for k in np.flatnonzero(common > _OVERLAP * smaller):
        raise LayoutError(f"cells {one[k]} and {other[k]} overlap by {common[k] * 1e6:.3g} mm^2")


def _with_touching_vertices(
    vertices: NDArray[np.float64], corners: list[tuple[int, ...]], tolerance: float
) -> list[tuple[int, ...]]:
    """Insert vertices on edges, so that touching cells share whole edges."""
    import shapely

    edges = [(a, b) for ring in corners for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)]
    lines = shapely.linestrings(vertices[np.array(edges)])
    on_edge, vertex = shapely.STRtree(shapely.points(vertices)).query(lines, predicate="dwithin", distance=tolerance)
    between: dict[int, list[tuple[float, int]]] = {}
    for e, v in zip(on_edge.tolist(), vertex.tolist(), strict=True):
        a, b = edges[e]
        along = vertices[b] - vertices[a]
        t = float((vertices[v] - vertices[a]) @ along / (along @ along))
        if v not in (a, b) and 0.0 < t < 1.0:
            between.setdefault(e, []).append((t, v))
    out = []
    e = 0
    for ring in corners:
        new: list[int] = []
        for a in ring:
            new += [a, *(v for _, v in sorted(between.get(e, [])) if v not in ring)]
            e += 1
        out.append(tuple(dict.fromkeys(new)))
    return out


def _outline_of(polygons: Sequence[object], grain: float) -> NDArray[np.float64]:
    import shapely

    union = shapely.union_all(polygons, grid_size=1e-3 * grain)
    if union.geom_type != "Polygon":
        union = shapely.union_all(polygons).convex_hull
    return np.asarray(shapely.get_coordinates(shapely.geometry.polygon.orient(shapely.Polygon(union.exterior)))[:-1])
