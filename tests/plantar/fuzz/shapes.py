"""Checks of the polygons and shapes: exact convexity, containment, areas, distances, bounds from theorems."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.bench import references as exact
from plantar.geometry import enclosing, inscribed, polygon
from plantar.geometry.inscribed import safe_rectangle
from plantar.geometry.outline import Outline, concave_outline, feet_outline
from plantar.percepts.sole_pose import feet_support_polygon

from .results import not_finite
from .rings import Rings
from .soles import Block
from .tally import Tally

__all__ = ["SHAPE_CHECKS"]

Array = NDArray[np.float64]
_EXACT = 1e-12
_MAPS: dict[int, Array] = {
    5: np.array([[1.0, 0.5], [0.0, 0.0]]),
    7: 1e-9 * np.eye(2),
    8: 1e6 * np.eye(2),
    10: np.diag([1.0, 1e-9]),
}
"""Of `_variant`: what puts points on a line, makes them tiny or huge, and makes a needle of them."""


def _relative(one: Array, other: Array, scale: Array) -> Array:
    """Difference over a scale; 0 over 0 is 0."""
    return np.asarray(np.abs(one - other) / np.where(scale > 0.0, scale, 1.0))


def _slack(rings: Rings) -> Array:
    """Distance in m that rounding explains: some units in the last place, and 1e-13 of the extent."""
    return 8.0 * rings.ulp + 1e-13 * rings.extent


def _shapes(corners: Sequence[Array], count: int) -> Array:
    """Corners of shapes (readings, count, 2); of those of empty polygons NaN-free zeros."""
    if not all(map(len, corners)):
        none = np.zeros((count, 2))
        corners = [c if len(c) else none for c in corners]
    return np.concatenate(corners).reshape(-1, count, 2)


def _are_none(corners: Sequence[Array]) -> NDArray[np.bool_]:
    """Which shapes (readings,) have no corners."""
    return np.asarray(np.fromiter(map(len, corners), dtype=np.intp, count=len(corners)) == 0)


def _areas(corners: Array) -> Array:
    x, y = (corners - corners[:, :1]).T  # the last edge ends at the first corner, which is 0 here
    return np.asarray(0.5 * (x[:-1] * y[1:] - y[:-1] * x[1:]).sum(axis=0))


def _percept_support(block: Block, tally: Tally) -> None:
    """Support polygon of each percept: convex exactly, around all corners, its area and centroid."""
    layout, percepts = block.layout, block.percepts
    hulls, rings = [p.support_polygon_in_sole for p in percepts], block.hulls
    tally.add("Percept.support_polygon_in_sole: convex", block, rings.not_convex())
    used = np.zeros((len(block), len(layout.vertices)), dtype=bool)
    for i in range(len(layout)):
        used[:, list(layout.corners[i])] |= block.active[:, i : i + 1]
    wrong_size = (rings.size > 0) != block.active.any(axis=1)
    tally.add("Percept.support_polygon_in_sole: empty", block, wrong_size)
    points = np.broadcast_to(layout.vertices[:, :2], (len(block), *layout.vertices[:, :2].shape))
    outside = np.where(used & (rings.size > 2)[:, None], -rings.depth(points), 0.0).max(axis=1)
    error = np.maximum(outside, 0.0) / np.maximum(_slack(rings), 1e-300)
    tally.add("Percept.support_polygon_in_sole: holds cells", block, error, 1.0)
    areas = np.array([p.support_area for p in percepts])
    tally.add("Percept.support_area", block, _relative(areas, rings.area, np.abs(rings.area)), _EXACT)
    sample = range(0, len(block), 100)
    right = np.array([exact.area_exact([hulls[i]]) if len(hulls[i]) else 0.0 for i in sample])
    tally.add("Percept.support_area: exact", block, _relative(areas[::100], right, right), _EXACT, len(right))
    full = np.array([exact.hull_area_exact(layout.vertices[used[i], :2]) if used[i].any() else 0.0 for i in sample])
    tally.add("Percept.support_area: exact hull", block, _relative(areas[::100], full, full), _EXACT, len(full))
    centroids = [p.centroid_in_sole for p in percepts]
    missing = np.array([c is None for c in centroids]) != (rings.size == 0)
    tally.add("Percept.centroid_in_sole: None without contact", block, missing)
    places = np.array([np.zeros(2) if c is None else c for c in centroids])
    depth = np.where(rings.size > 0, -rings.depth(places[:, None])[:, 0], 0.0)
    tally.add(
        "Percept.centroid_in_sole: inside", block, np.maximum(depth, 0.0) / np.maximum(rings.extent, 1e-300), _EXACT
    )
    ratio = np.array([p.area_ratio for p in percepts])
    tally.add("Percept.area_ratio", block, _relative(ratio * layout.sole_area, areas, areas), _EXACT)
    cops = [p.position_cop_in_sole for p in percepts]
    place = np.array([np.zeros(2) if c is None else c for c in cops])
    have = np.array([c is not None for c in cops])
    depth = np.where(have, -rings.depth(place[:, None])[:, 0], 0.0)
    tally.add(
        "Percept.position_cop_in_sole: inside", block, np.maximum(depth, 0.0) / np.maximum(rings.extent, 1e-300), 1e-9
    )


def _percept_outline(block: Block, tally: Tally) -> None:
    """Concave outline: its area is that of the cells, no more than that of the hull; moved and joined outlines."""
    layout = block.layout
    outlines = [p.concave_outline_in_sole for p in block.percepts]
    cells = np.array([abs(polygon.area(layout.cell_polygon(i))) for i in range(len(layout))])
    wanted = block.active @ cells
    got = np.array([o.area for o in outlines])
    tally.add("Percept.concave_outline_in_sole: area of the cells", block, _relative(got, wanted, wanted), _EXACT)
    hull = np.array([p.support_area for p in block.percepts])
    over = np.maximum(got - hull, 0.0) / np.maximum(hull, 1e-300)
    tally.add("Percept.concave_outline_in_sole: within the hull", block, over, _EXACT)
    middles = [math.nan if (m := o.centroid) is None and len(o) else m for o in outlines]
    for outline, middle, wrong in zip(outlines, middles, not_finite(middles), strict=True):
        if wrong and len(outline):
            raise ValueError(f"an outline of area {outline.area} has the centroid {middle}")
    islands = [sum(map(len, o.islands)) for o in outlines]
    tally.add("Outline.islands", block, [a != len(o) for a, o in zip(islands, outlines, strict=True)])
    turn, shift = block.pose.rotation_sole_to_world, block.pose.position_in_world
    moved = [o.moved(turn, shift) for o in outlines]
    reach = float(np.abs(shift).max()) + 1.0
    rings = Rings([o.points for o in outlines])
    size = np.where(rings.size > 0, rings.extent, 1.0)
    allowed = 1e-12 * wanted + 64.0 * 2.3e-16 * reach * size * (rings.size + 1)
    lost = np.abs(np.array([m.area for m in moved]) - wanted) / np.maximum(allowed, 1e-300)
    tally.add("Outline.moved", block, np.where(wanted > 0.0, lost, 0.0), 1.0)
    pairs = range(0, len(block) - 1, 2)  # a reading each foot
    apart = [feet_outline([outlines[i], outlines[i + 1].moved(np.eye(2), [3.0, 0.0])]) for i in pairs]
    both = np.array([o.area for o in apart])
    sums = wanted[: 2 * len(apart) : 2] + wanted[1::2]
    tally.add("feet_outline", block, _relative(both, sums, sums), 1e-9, 2 * len(apart))
    direct = [concave_outline(layout, np.ascontiguousarray(block.active[i])).area for i in range(0, len(block), 16)]
    tally.add("concave_outline", block, _relative(np.array(direct), wanted[::16], wanted[::16]), _EXACT, len(direct))


def _percept_shapes(block: Block, tally: Tally) -> None:
    """The members that are shapes, on the sole as it is."""
    percepts = block.percepts
    hulls = block.hulls
    _inside(
        block, tally, "Percept.inscribed_triangle_in_sole", hulls, [p.inscribed_triangle_in_sole for p in percepts], 3
    )
    for name in ("parallelogram", "rectangle", "rectangle_any_angle"):
        member = f"inscribed_{name}_in_sole"
        _inside(block, tally, f"Percept.{member}", hulls, [getattr(p, member) for p in percepts], 4)
    for member in ("bounding_box_in_sole", "oriented_box_in_sole", "enclosing_parallelogram_in_sole"):
        _around(block, tally, f"Percept.{member}", hulls, [getattr(p, member) for p in percepts])
    circles = [p.inscribed_circle_in_sole for p in percepts]
    _circles(block, tally, "Percept.inscribed_circle_in_sole", hulls, circles)
    axis = _areas(_shapes([p.inscribed_rectangle_in_sole for p in percepts], 4))
    free = _areas(_shapes([p.inscribed_rectangle_any_angle_in_sole for p in percepts], 4))
    hull = np.array([p.support_area for p in percepts])
    less = np.maximum(axis - free, 0.0) / np.maximum(hull, 1e-300)
    tally.add("rectangle at any angle: not less than along the axes", block, less, 1e-6)
    half = np.maximum(0.5 * hull - free, 0.0) / np.maximum(hull, 1e-300)  # Radziszewski: half of any convex polygon
    tally.add("rectangle at any angle: half of the polygon", block, half, 1e-6)


def _percept_outline_shapes(block: Block, tally: Tally) -> None:
    """Rectangles in the concave outline: inside, no more than in the hull, no less than in one cell."""
    percepts = block.percepts
    corners = [p.outline_rectangle_in_sole for p in percepts]
    got = _areas(_shapes(corners, 4))
    hull = _areas(_shapes([p.inscribed_rectangle_in_sole for p in percepts], 4))
    over = np.maximum(got - hull, 0.0) / np.maximum(hull, 1e-300)
    tally.add("Percept.outline_rectangle_in_sole: within the hull's", block, over, 1e-12)
    _in_outline(block, tally, "Percept.outline_rectangle_in_sole: inside", corners, range(0, len(block), 50))
    found = [p.outline_rectangle_any_angle_in_sole for p in percepts]
    free, gap = [f.corners for f in found], np.array([f.gap for f in found])
    rare = range(block.number % 20, len(block), 100)
    _in_outline(block, tally, "Percept.outline_rectangle_any_angle_in_sole: inside", free, rare)
    wide = _areas(_shapes(free, 4))
    less = np.maximum(got - wide * (1.0 + gap), 0.0) / np.maximum(got, 1e-300)
    tally.add("Percept.outline_rectangle_any_angle_in_sole: not less than its stated gap allows", block, less, 1e-12)
    hull = _areas(_shapes([p.inscribed_rectangle_any_angle_in_sole for p in percepts], 4))
    over = np.maximum(wide - hull, 0.0) / np.maximum(hull, 1e-300)
    tally.add("Percept.outline_rectangle_any_angle_in_sole: within the hull's", block, over, 1e-6)


def _in_outline(block: Block, tally: Tally, name: str, corners: Sequence[Array], which: Sequence[int]) -> None:
    """Area of a rectangle outside its outline, by shapely, over its own area."""
    import shapely

    picked = corners if len(corners) == len(which) else [corners[i] for i in which]
    lost = []
    for i, ring in zip(which, picked, strict=True):
        outline = block.percepts[i].concave_outline_in_sole
        if not len(outline):
            lost.append(float(len(ring) > 0))
            continue
        base, size = outline.points[0], float(np.ptp(outline.points, axis=0).max())
        parts = [shapely.Polygon((p[0] - base) / size, [(h - base) / size for h in p[1:]]) for p in outline.islands]
        rectangle = shapely.Polygon((ring - base) / size)
        outside = shapely.area(shapely.difference(rectangle, shapely.union_all([shapely.make_valid(p) for p in parts])))
        lost.append(float(outside / shapely.area(rectangle)) if shapely.area(rectangle) > 0.0 else 1.0)
    tally.add(name, block, lost, 1e-9, len(lost))


def _inside(block: Block, tally: Tally, name: str, rings: Rings, corners: Sequence[Array], count: int) -> None:
    """A shape inside convex polygons: corners within, area within the bounds that theorems give."""
    shape = _shapes(corners, count)
    filled = rings.size > 0
    tally.add(f"{name}: none for an empty polygon", block, _are_none(corners) == filled)
    out = np.where(filled, np.maximum(-rings.depth(shape).min(axis=1), 0.0), 0.0)
    out = np.where(np.isfinite(out), out, 0.0)
    error = np.where(filled, out / np.maximum(_slack(rings), 1e-300), 0.0) + np.where(
        np.isfinite(shape).all(axis=(1, 2)), 0.0, np.nan
    )
    tally.add(f"{name}: inside", block, error, 4.0)
    size, got = np.abs(rings.area), _areas(shape)
    loose = 1e-12 * size + 16.0 * rings.ulp * rings.extent
    if "triangle" in name:
        best = _largest_triangles(rings)
        tally.add(f"{name}: largest", block, np.abs(got - best) / np.maximum(loose, 1e-300), 1.0)
    elif "parallelogram" in name:
        tally.add(f"{name}: half or more", block, np.maximum(0.5 * size - got, 0.0) / np.maximum(loose, 1e-300), 1.0)
    over = np.maximum(got - size, 0.0) / np.maximum(loose, 1e-300)
    tally.add(f"{name}: no more than the polygon", block, over, 1.0)


def _largest_triangles(rings: Rings) -> Array:
    """Area of the largest triangle on vertices, all of them tried (readings,); of rings that are the same once."""
    best = np.zeros(len(rings.size))
    for size in np.unique(rings.size).tolist():
        rows = np.flatnonzero(rings.size == size)
        place: dict[bytes, int] = {}
        same = [place.setdefault(ring.tobytes(), len(place)) for ring in rings.points[rows, :size]]
        first = rows[np.unique(same, return_index=True)[1]]
        x, y = rings.points[first, :size].T
        most = np.zeros(len(first))
        for a in range(size - 2):
            dx, dy = x[a + 1 :] - x[a], y[a + 1 :] - y[a]
            cross = dx[:, None] * dy
            twice = cross - cross.transpose(1, 0, 2)  # each triangle with both signs
            most = np.maximum(most, 0.5 * twice.max(axis=(0, 1)))
        best[rows] = most[same]
    return best


def _around(block: Block, tally: Tally, name: str, rings: Rings, corners: Sequence[Array]) -> None:
    """A shape around convex polygons: holds every vertex, area within the bounds that theorems give."""
    filled = rings.size > 0
    tally.add(f"{name}: none for an empty polygon", block, _are_none(corners) == filled)
    shape = _shapes(corners, 4)
    box = Rings(list(shape))
    slack = np.maximum(_slack(rings) + _slack(box), 1e-300)
    out = np.where(filled & (rings.size > 2), np.maximum(-box.depth(rings.points).min(axis=1), 0.0), 0.0)
    error = out / slack + np.where(np.isfinite(shape).all(axis=(1, 2)), 0.0, np.nan)
    tally.add(f"{name}: around", block, error, 4.0)
    size, got = np.abs(rings.area), _areas(shape)
    loose = 1e-12 * size + 16.0 * rings.ulp * rings.extent
    error = np.maximum(size - got, 0.0) / np.maximum(loose, 1e-300)
    if "bounding" not in name:  # both are at most twice the polygon
        error = np.maximum(error, np.maximum(got - 2.0 * size, 0.0) / np.maximum(loose, 1e-300))
    tally.add(f"{name}: area", block, error, 1.0)


def _circles(block: Block, tally: Tally, name: str, rings: Rings, circles: Sequence[inscribed.Circle | None]) -> None:
    """Largest circles: as deep as their radius, and between area / perimeter and twice that."""
    tally.add(
        f"{name}: None for an empty polygon",
        block,
        [(c is None) != (k == 0) for c, k in zip(circles, rings.size, strict=True)],
    )
    centre = np.array([np.zeros(2) if c is None else c.center for c in circles])
    radius = np.array([0.0 if c is None else c.radius for c in circles])
    depth = rings.depth(centre[:, None])[:, 0]
    solid = rings.size > 2
    error = np.where(solid, np.abs(np.where(solid, depth, 0.0) - radius) / np.maximum(_slack(rings), 1e-300), 0.0)
    tally.add(f"{name}: touches", block, error, 8.0)
    low = np.abs(rings.area) / np.maximum(rings.length.sum(axis=1), 1e-300)
    off = np.maximum(low - radius, radius - 2.0 * low) / np.maximum(1e-12 * low + _slack(rings), 1e-300)
    tally.add(f"{name}: radius", block, np.where(solid, np.maximum(off, 0.0), 0.0), 4.0)


def _variant(points: Array, kind: int, rng: np.random.Generator) -> Array:
    """Points as no sole would give them: far away, clockwise, repeated, on a line, at one place, tiny, huge."""
    turn = 6.3 * rng.random()
    if kind in _MAPS:
        return np.asarray(points @ _MAPS[kind])
    if kind == 11:
        c, s = math.cos(turn), math.sin(turn)
        return np.asarray(points @ np.array([[c, s], [-s, c]]))
    if kind == 1:
        return np.asarray(points + np.array([1e6, -1e6]))
    if kind == 2:
        return points[::-1]
    if kind == 3:
        return np.repeat(points, 2, axis=0)
    if kind == 4 and len(points):  # midpoints on every edge
        between = 0.5 * (points + np.roll(points, -1, axis=0))
        return np.stack([points, between], axis=1).reshape(-1, 2)
    if kind == 6:
        return points[:1].repeat(4, axis=0)
    return points[: int(rng.integers(0, 4))] if kind == 9 else points


def _plane_polygons(block: Block, tally: Tally) -> None:
    """The functions of convex polygons on polygons far away, clockwise, repeated, on a line, tiny and huge."""
    rng = block.rng
    cloud = [_variant(p.support_polygon_in_sole, i % 12, rng) for i, p in enumerate(block.percepts)]
    hulls = [polygon.convex_hull(rng.permutation(c)) for c in cloud]
    rings = Rings(hulls)
    tally.add("convex_hull: convex", block, rings.not_convex())
    given = Rings(cloud)
    outside = np.where(rings.size > 2, -rings.depth(given.points).min(axis=1), 0.0)
    tally.add("convex_hull: holds the points", block, np.maximum(outside, 0.0) / np.maximum(_slack(rings), 1e-300), 1.0)
    dirty = [np.concatenate([c, [[np.nan, 0.0], [np.inf, 1.0]]]) for c in cloud[::8]]
    same = [
        np.array_equal(polygon.convex_hull(d), polygon.convex_hull(c)) for d, c in zip(dirty, cloud[::8], strict=True)
    ]
    tally.add("convex_hull: NaN left out", block, ~np.array(same), 0.0, len(same))
    areas = np.array([polygon.area(c) for c in cloud])
    right = given.area
    size = np.maximum(given.extent**2, 1e-300)
    tally.add("area", block, np.abs(areas - right) / size, 1e-12)
    middles = [polygon.centroid(c) for c in cloud]
    tally.add(
        "centroid: None for an empty polygon",
        block,
        [(m is None) != (len(c) == 0) for m, c in zip(middles, cloud, strict=True)],
    )
    middle = np.array([np.zeros(2) if m is None else m for m in middles])
    depth = np.where(rings.size > 2, -rings.depth(middle[:, None])[:, 0], 0.0)
    tally.add(
        "centroid: inside",
        block,
        np.maximum(depth, 0.0) / np.maximum(_slack(rings) + 1e-12 * rings.extent, 1e-300),
        8.0,
    )
    _points(block, tally, cloud, rings, middle)
    circles = [inscribed.inscribed_circle(c) for c in cloud]
    _offsets(block, tally, cloud, rings, circles)
    _inside(block, tally, "safe_rectangle", rings, [safe_rectangle(c, 0.01) for c in cloud], 4)
    some = slice(block.number % 4, None, 4)  # the percepts call the same functions with every reading
    _all_shapes(block, tally, cloud[some], hulls[some], circles[some])


def _points(block: Block, tally: Tally, cloud: Sequence[Array], rings: Rings, middle: Array) -> None:
    """Closest points and margins: idempotent, on or in the polygon, at the distance that all edges give."""
    aim = middle + np.maximum(rings.extent, 1e-3)[:, None] * block.rng.uniform(-1.5, 1.5, (len(block), 2))
    found = [polygon.closest_point(c, a) for c, a in zip(cloud, aim, strict=True)]
    margin = np.array([polygon.signed_margin(c, a) for c, a in zip(cloud, aim, strict=True)])
    near = np.array([a if f is None else f for f, a in zip(found, aim, strict=True)])
    again = [polygon.closest_point(c, n) for c, n in zip(cloud, near, strict=True)]
    near_again = np.array([a if f is None else f for f, a in zip(again, aim, strict=True)])
    have = rings.size > 0
    reach = 8.0 * np.maximum(rings.ulp, 2.3e-16 * np.abs(aim).max(axis=1)) + 1e-13 * np.maximum(rings.extent, 1e-3)
    tally.add(
        "closest_point: None for an empty polygon",
        block,
        [(f is None) == bool(k) for f, k in zip(found, have, strict=True)],
    )
    tally.add(
        "closest_point: idempotent", block, np.where(have, np.abs(near - near_again).max(axis=1) / reach, 0.0), 1.0
    )
    truth = rings.distance(aim)
    inside = (rings.size > 2) & (rings.depth(aim[:, None])[:, 0] > 0.0)
    gap = np.hypot(*(near - aim).T)
    tally.add(
        "closest_point: distance", block, np.where(have, np.abs(gap - np.where(inside, 0.0, truth)) / reach, 0.0), 4.0
    )
    signed = np.where(inside, truth, -truth)
    wrong = np.where(have, np.abs(np.where(have, margin, 0.0) - signed) / reach, (margin != -np.inf).astype(float))
    tally.add("signed_margin", block, wrong, 4.0)
    lost = [polygon.closest_point(c, [np.nan, 0.0]) for c in cloud[::50] if len(c)]
    tally.add(
        "closest_point: NaN for NaN", block, [not np.isnan(v).all() for v in lost if v is not None], 0.0, len(lost)
    )


def _offsets(
    block: Block, tally: Tally, cloud: Sequence[Array], rings: Rings, circles: Sequence[inscribed.Circle | None]
) -> None:
    """Inner offsets: every vertex at the distance exactly, or the deepest point, as deep as the largest circle."""
    distance = rings.extent * block.rng.choice([0.0, 1e-6, 0.03, 0.1, 0.3, 2.0], len(block))
    smaller = [polygon.inner_offset(c, float(d)) for c, d in zip(cloud, distance, strict=True)]
    inner = Rings(smaller)
    solid = rings.size > 2
    depth = rings.depth(inner.points)
    radius = np.array([0.0 if c is None else c.radius for c in circles])
    wanted = np.where((inner.size == 1) & (radius < distance), radius, distance)
    flat = np.abs(rings.area) / np.maximum(rings.extent**2, 1e-300) < 1e-7  # a needle: its depth is rounding
    error = np.where(solid[:, None] & ~flat[:, None], np.abs(depth - wanted[:, None]), 0.0).max(axis=1)
    tally.add("inner_offset: margin", block, error / np.maximum(_slack(rings) + 1e-12 * rings.extent, 1e-300), 4.0)
    tally.add(
        "inner_offset: convex",
        block,
        np.where(inner.size > 2, -inner.area, 0.0).clip(min=0.0) / np.maximum(rings.extent**2, 1e-300),
        1e-15,
    )
    tally.add("inner_offset: empty", block, (inner.size == 0) != (np.array([len(c) for c in cloud]) == 0))


def _all_shapes(
    block: Block,
    tally: Tally,
    cloud: Sequence[Array],
    hulls: Sequence[Array],
    circles: Sequence[inscribed.Circle | None],
) -> None:
    """The inscribed and enclosing shapes of odd polygons."""
    rings = Rings(hulls)
    functions: tuple[tuple[str, Callable[[Array], Array], int], ...] = (
        ("inscribed_triangle", inscribed.inscribed_triangle, 3),
        ("inscribed_parallelogram", inscribed.inscribed_parallelogram, 4),
        ("inscribed_rectangle", inscribed.inscribed_rectangle, 4),
    )
    for name, function, count in functions:
        _inside(block, tally, name, rings, [function(c) for c in cloud], count)
    turned = [inscribed.inscribed_rectangle(c, 0.7 + 0.01 * i) for i, c in enumerate(cloud)]
    _inside(block, tally, "inscribed_rectangle, turned", rings, turned, 4)
    _inside(
        block,
        tally,
        "inscribed_rectangle_any_angle",
        rings,
        [inscribed.inscribed_rectangle_any_angle(c) for c in cloud],
        4,
    )
    _circles(block, tally, "inscribed_circle", rings, circles)
    for name, around in (
        ("bounding_box", enclosing.bounding_box),
        ("oriented_box", enclosing.oriented_box),
        ("enclosing_parallelogram", enclosing.enclosing_parallelogram),
    ):
        _around(block, tally, name, rings, [around(c) for c in cloud])
    shifted = [c + np.array([0.5, 0.0]) for c in cloud]
    both = Rings([feet_support_polygon([a, b]) for a, b in zip(cloud, shifted, strict=True)])
    tally.add("feet_support_polygon: convex", block, both.not_convex())
    outside = np.where(both.size > 2, -both.depth(Rings(cloud).points).min(axis=1), 0.0)
    tally.add(
        "feet_support_polygon: holds both", block, np.maximum(outside, 0.0) / np.maximum(_slack(both), 1e-300), 1.0
    )
    whole = [Outline.of_rings([h]) for h in hulls[::8]]
    corners = [inscribed.rectangle_in_outline(o) for o in whole]
    right = np.array(
        [
            _areas(inscribed.inscribed_rectangle(h)[None])[0] if len(o) else 0.0
            for h, o in zip(hulls[::8], whole, strict=True)
        ]
    )
    got = _areas(_shapes(corners, 4))
    size = np.maximum(1e-9 * rings.extent**2 + 64.0 * rings.ulp * rings.extent, 1e-300)[::8]
    tally.add("rectangle_in_outline: as in the polygon", block, np.abs(got - right) / size, 1.0, len(whole))


SHAPE_CHECKS = (_percept_support, _percept_outline, _percept_shapes, _percept_outline_shapes, _plane_polygons)
"""The checks of this module, each a function of a block and a tally."""
