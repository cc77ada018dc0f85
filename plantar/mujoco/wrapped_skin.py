"""A patch of skin on the surface of a body's geoms: its cells, frame and kernel."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array
from plantar.common.sides import Side, other_side
from plantar.errors import RobotError
from plantar.layouts.layout import DEFAULT_THRESHOLDS, SoleLayout, mirrored
from plantar.layouts.tiling import hex_layout
from plantar.mujoco.geom_surface import GeomSurface, body_surfaces
from plantar.mujoco.mirrored_body import LeftBody, left_body
from plantar.mujoco.sole_shape import axes_facing, unit_vector
from plantar.mujoco.surface_patch import Region, Samples, SurfaceCells, refuse_strip, sampled, spread_cells, width_of
from plantar.sensing.link_skin import SkinPatch

_CELL_AREA = 691e-6  # m^2, of the papers' soles
_CELLS = 30  # at least so many of a small skin that is fitted
_COARSE = 40  # samples along the body's largest extent, from which the patch's area is known to some per cent
_LOOKS = 0.1  # cosine of the angle to the frame's z from which a cell counts as looking the patch's way
_PLANE = 1e-6  # m, or of a normal's components: float32 meshes
_FINEST = 2e-4  # m: no samples closer than this
_MOST_SAMPLES = 400_000
_FAR = 30.0  # times the body: a polygon that reaches farther is drawn in mm or cm


class WrappedSkin(NamedTuple):
    """A patch: `layout` of its cells, in its frame; `position` (3,) and `rotation` (3, 3) of the frame in the body's;
    `rings`: corners (k, 3) of each cell in its frame; `kernel`: arguments of `PatchLoad`.
    """

    layout: SoleLayout | SkinPatch
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    rings: list[NDArray[np.float64]]
    kernel: tuple[Any, ...]


def wrapped_skin(
    model: Any,
    body: int,
    geoms: Sequence[int],
    *,
    side: Side | None,
    cell_area: float | None,
    least_level: float,
    outward: ArrayLike | None,
    within: float,
    around: ArrayLike | None,
    region: ArrayLike | None,
    polygon: ArrayLike | None,
    forward: ArrayLike | None,
) -> WrappedSkin:
    """Lay cells on the part of a body's surface of which all conditions hold; arguments as of `Skin`.

    `least_level`: force in N of all taxels from which they are active. RobotError: nothing there, or a strip.
    """
    wanted = _Wanted(model.body(body).name, side, cell_area, least_level)
    name = wanted.name
    surfaces = body_surfaces(model, body, geoms)
    outline = _drawn(polygon)
    reach = float(np.abs(_bounds(surfaces)).max())
    drawn = float(np.abs(outline).max(initial=0.0))
    if drawn > _FAR * reach:
        raise RobotError(f"the drawn polygon reaches {drawn:.3g} m, and body '{name}' {reach:.3g} m; is it in m?")
    out = None if outward is None else unit_vector(outward, "outward")
    ahead = None if forward is None else unit_vector(forward, "forward")
    rotation = _axes(out, ahead)
    chosen = Region(
        out,
        math.radians(within),
        None if around is None else unit_vector(around, "around"),
        *_box(region),
        outline,
        np.ascontiguousarray(rotation[:, :2].T),
    )
    left = left_body(model, body, surfaces)
    if left is not None:
        try:
            laid = _brought(model, left, wanted, chosen, rotation, ahead)
        except RobotError:  # both sides refuse, this one by its own places where it can
            _laid(model, body, surfaces, wanted, chosen, rotation)
            raise
    else:
        laid = _laid(model, body, surfaces, wanted, chosen, rotation)
    kernel = _kernel(model, geoms, surfaces, laid.layout, laid.radius, chosen, laid.position, rotation)
    return WrappedSkin(laid.layout, laid.position, rotation, laid.rings, kernel)


class _Wanted(NamedTuple):
    """What was asked for beside the region: the body's `name` in messages, others as of `wrapped_skin`."""

    name: str
    side: Side | None
    cell_area: float | None
    least_level: float


class _Laid(NamedTuple):
    """Cells in the patch's frame, its place (3,) in the body's, corners of each, and how far a contact reaches."""

    layout: SoleLayout | SkinPatch
    position: NDArray[np.float64]
    rings: list[NDArray[np.float64]]
    radius: float


def _laid(
    model: Any,
    body: int,
    surfaces: list[GeomSurface],
    wanted: _Wanted,
    chosen: Region,
    rotation: NDArray[np.float64],
) -> _Laid:
    """Lay cells on the chosen part of a body's own surfaces."""
    out = chosen.outward
    where = f"the skin of body '{wanted.name}'"
    own_side = wanted.side or _side_of(model, body)
    is_right = own_side == "right"
    low, high = _bounds(surfaces)
    first = float((high - low).max()) / _COARSE
    try:
        coarse = _chosen(surfaces, first, is_right, chosen, where)
    except RobotError:  # a small region may lie between the samples
        coarse = _chosen(surfaces, max(0.1 * first, _FINEST), is_right, chosen, where)
    total = float(coarse.areas.sum())
    area = wanted.cell_area or fitted_cell_area(total)
    pitch = max(width_of(area) / 8.0, _FINEST)
    pitch = max(pitch, math.sqrt(6.0 * float(np.prod(np.sort(high - low)[1:])) / _MOST_SAMPLES))
    try:
        samples = _chosen(surfaces, pitch, is_right, chosen, where)
    except RobotError:  # which the coarse samples were not
        raise RobotError(
            f"{where}: a cell of {area:g} m^2 is too large for its surface of {total:.3g} m^2; give a smaller cell_area"
        ) from None
    flat = _flat_outline(surfaces, samples, chosen, rotation) if out is not None else None
    if flat is None:
        cells = spread_cells(samples, area, where)
        position = np.zeros(3)
        if out is not None:
            position = float((cells.positions @ out).max()) * out
        layout, rings = _curved_layout(own_side, cells, wanted, position, rotation)
        return _Laid(layout, position, rings, cells.radius)
    outline, height = flat
    refuse_strip(*_long_and_thin(outline), width_of(area), where)
    level = flat_layout(wanted.name, own_side, outline, area, wanted.least_level)
    rings = [np.column_stack([level.cell_polygon(i), np.zeros(len(level.corners[i]))]) for i in range(len(level))]
    return _Laid(level, height * np.asarray(out), rings, 1.25 * width_of(level.cell_area))


def _brought(
    model: Any,
    left: LeftBody,
    wanted: _Wanted,
    chosen: Region,
    rotation: NDArray[np.float64],
    ahead: NDArray[np.float64] | None,
) -> _Laid:
    """The left body's cells on the mirrored part of its surfaces, mirrored; arguments of the right body."""
    way = left.way
    out = None if chosen.outward is None else way @ chosen.outward
    its_rotation = _axes(out, None if ahead is None else way @ ahead)
    turn = rotation.T @ way.T @ its_rotation  # from its patch's frame to this one's
    ends = _mirrored_box(chosen.low, chosen.high, way)
    region = Region(
        out,
        chosen.within,
        None if chosen.axis is None else way @ chosen.axis,
        *ends,
        np.ascontiguousarray(chosen.outline @ turn[:2, :2]),
        np.ascontiguousarray(its_rotation[:, :2].T),
    )
    its = wanted if wanted.side is None else wanted._replace(side=other_side(wanted.side))
    laid = _laid(model, left.body, left.surfaces, its, region, its_rotation)
    layout = laid.layout
    places = layout.positions @ turn.T
    turns = _frames(layout.rotations[:, :, 2] @ turn.T)
    if isinstance(layout, SoleLayout):
        layout = replace(
            layout,
            side=other_side(layout.side),
            positions=places,
            rotations=turns,
            vertices=layout.vertices @ turn.T,
            corners=tuple((c[0], *reversed(c[1:])) for c in layout.corners),
            outline=(layout.outline @ turn[:2, :2].T)[::-1],
        )
    else:
        layout = replace(layout, positions=places, rotations=turns)
    return _Laid(layout, way.T @ laid.position, [(ring @ turn.T)[::-1] for ring in laid.rings], laid.radius)


def _mirrored_box(
    low: NDArray[np.float64], high: NDArray[np.float64], way: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners of a box, of which some may be infinite, in a frame whose axes are the same, reordered or reversed."""
    axes = np.abs(way).argmax(axis=1)
    along = way[range(3), axes] > 0.0
    return np.where(along, low[axes], -high[axes]), np.where(along, high[axes], -low[axes])


def _axes(out: NDArray[np.float64] | None, forward: NDArray[np.float64] | None) -> NDArray[np.float64]:
    """Rotation (3, 3) from patch to body: the body's axes, or z against `out` and x along the body's x."""
    if out is None:
        return np.eye(3)
    ahead = np.array([1.0, 0.0, 0.0]) if forward is None else forward
    if abs(ahead @ out) > 0.95:
        if forward is not None:
            raise RobotError("the patch faces the way that is given as forward; give forward=(x, y, z) along it")
        ahead = np.array([0.0, 0.0, 1.0])
    return axes_facing(out, ahead)


def _box(region: ArrayLike | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if region is None:
        return np.full(3, -np.inf), np.full(3, np.inf)
    corners = array(region, "region", (2, 3), RobotError)
    if np.isnan(corners).any() or not (corners[0] < corners[1]).all():
        raise RobotError(f"region {corners.tolist()} is empty; expected its low corner first, then its high corner")
    return corners[0].copy(), corners[1].copy()


def _drawn(polygon: ArrayLike | None) -> NDArray[np.float64]:
    if polygon is None:
        return np.zeros((0, 2))
    import shapely

    outline = array(polygon, "polygon", ("corners", 2), RobotError, finite=True)
    drawn = shapely.Polygon(outline) if len(outline) >= 3 else None
    if drawn is None or not drawn.is_valid or drawn.area <= 0.0:
        raise RobotError("the drawn polygon encloses no area or crosses itself; expected 3 corners or more, in order")
    return np.ascontiguousarray(outline)


def _side_of(model: Any, body: int) -> Side:
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    root = int(model.body_rootid[body])
    from_root = data.xpos[body] - data.xpos[root if root != body else 0]
    return "left" if float(from_root @ data.xmat[root].reshape(3, 3)[:, 1]) > -1e-9 else "right"


def _bounds(surfaces: list[GeomSurface]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest corner (3,) of a box about surfaces."""
    boxes = np.array([s.bounds() for s in surfaces])
    return boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)


def _chosen(surfaces: list[GeomSurface], pitch: float, is_right: bool, region: Region, where: str) -> Samples:
    """The samples in a region; RobotError for none."""
    every = sampled(surfaces, pitch, is_right)
    found = every.part(region.has(every.points, every.normals))
    if not len(found.points):
        low, high = (corner.round(4).tolist() for corner in _bounds(surfaces))
        raise RobotError(
            f"{where}: no surface lies there that faces so; its shapes reach from {low} to {high} m in its frame; "
            "allowed: outward, around, region and polygon that have a part of it in common"
        )
    return found


def _flat_outline(
    surfaces: list[GeomSurface], samples: Samples, region: Region, rotation: NDArray[np.float64]
) -> tuple[NDArray[np.float64], float] | None:
    """Outline (k, 2) in the patch's x and y, and height of a patch that is one flat piece, seen along its normal."""
    import shapely

    out = np.asarray(region.outward)
    heights = samples.points @ out
    if np.abs(samples.normals - out).max() > _PLANE or float(np.ptp(heights)) > _PLANE:
        return None
    height = float(heights.mean())
    pieces = []
    for surface in surfaces:
        for ring in surface.faces():
            if np.abs(ring @ out - height).max() < 2.0 * _PLANE:
                kept = _clipped(ring, region.low, region.high)
                if len(kept) >= 3:
                    pieces.append(shapely.Polygon(kept @ rotation[:, :2]))
    whole = shapely.union_all(pieces)
    if len(region.outline):
        whole = whole.intersection(shapely.Polygon(region.outline))
    if whole.geom_type != "Polygon" or len(whole.interiors):
        return None
    if abs(whole.area - float(samples.areas.sum())) > 0.2 * whole.area:  # a part is inside of another geom
        return None
    return np.ascontiguousarray(shapely.get_coordinates(shapely.orient_polygons(whole))[:-1]), height


def _clipped(ring: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """A convex polygon (k, 3) within a box."""
    for axis in range(3):
        for sign, bound in ((1.0, high[axis]), (-1.0, -low[axis])):
            if not math.isfinite(bound) or not len(ring):
                continue
            over = sign * ring[:, axis] - bound
            kept = []
            for i in range(len(ring)):
                j = (i + 1) % len(ring)
                if over[i] <= 0.0:
                    kept.append(ring[i])
                if over[i] * over[j] < 0.0:
                    share = over[i] / (over[i] - over[j])
                    kept.append(ring[i] + share * (ring[j] - ring[i]))
            ring = np.array(kept).reshape(-1, 3)
    return ring


def flat_layout(name: str, side: Side, outline: NDArray[np.float64], area: float, least_level: float) -> SoleLayout:
    """Cells of an `area` in m^2 in a flat outline (k, 2); `least_level`: force in N of all from which they are active.

    A right one is the left one, mirrored: mirrored bodies have mirrored cells. The outline is taken to a nanometre, so
    that rounding decides nowhere which cells are in.
    """
    import shapely

    shown = np.round(outline * np.array([1.0, -1.0 if side == "right" else 1.0]), 9)
    middle = shapely.Polygon(shown).centroid
    layout = hex_layout(shown, name=name, side="left", cell_area=area, origin=(round(middle.x, 9), round(middle.y, 9)))
    return _with_level(mirrored(layout) if side == "right" else layout, least_level)


def fitted_cell_area(whole: float) -> float:
    """Area in m^2 of a cell where none is stated, on a skin of an area in m^2."""
    return min(_CELL_AREA, whole / _CELLS)


def _long_and_thin(outline: NDArray[np.float64]) -> tuple[float, float]:
    """Length and width in m of the least rectangle about an outline (k, 2)."""
    import shapely

    box = shapely.get_coordinates(shapely.Polygon(outline).minimum_rotated_rectangle)
    thin, long = sorted(np.hypot(*(box[1:3] - box[:2]).T).tolist())
    return long, thin


def _with_level(layout: SoleLayout, least_level: float) -> SoleLayout:
    level = min(layout.force_threshold, least_level / len(layout))
    return replace(layout, thresholds={**layout.thresholds, "force": level})


def _curved_layout(
    side: Side,
    cells: SurfaceCells,
    wanted: _Wanted,
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
) -> tuple[SoleLayout | SkinPatch, list[NDArray[np.float64]]]:
    """Cells in the patch's frame: a sole's layout if all look its way, else a link's patch."""
    places = (cells.positions - position) @ rotation
    inward = -cells.normals @ rotation
    turns = _frames(inward)
    rings = [(ring - position) @ rotation for ring in cells.rings]
    level = min(DEFAULT_THRESHOLDS["force"], wanted.least_level / len(places))
    if not (inward[:, 2] > _LOOKS).all():
        return SkinPatch(wanted.name, wanted.name, places, turns, cells.areas, level, 0.0, cells.neighbours), rings
    import shapely

    flat = [shapely.Polygon(ring[:, :2]) for ring in rings]
    hull = shapely.union_all([f.convex_hull for f in flat]).convex_hull
    starts = np.cumsum([0, *(len(ring) for ring in rings)])
    layout = SoleLayout(
        name=wanted.name,
        side=side,
        positions=places,
        rotations=turns,
        vertices=np.vstack(rings),
        corners=tuple(
            tuple(range(a, b))[:: 1 if shapely.is_ccw(shapely.LinearRing(ring[:, :2])) else -1]
            for a, b, ring in zip(starts[:-1].tolist(), starts[1:].tolist(), rings, strict=True)
        ),
        neighbours=cells.neighbours,
        areas=cells.areas,
        outline=shapely.get_coordinates(shapely.orient_polygons(hull))[:-1],
        ids=np.arange(len(places)),
        cell_shape="polygon",
        cell_area=float(np.median(cells.areas)),
    )
    return _with_level(layout, wanted.least_level), rings


def _frames(inward: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotations (n, 3, 3) with z along `inward` (n, 3) and x as near the patch's x as can be."""
    ahead = np.where(np.abs(inward[:, :1]) > 0.95, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    x = ahead - np.einsum("ij,ij->i", ahead, inward)[:, None] * inward
    x /= np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(inward, x), inward], axis=2)


def _kernel(
    model: Any,
    geoms: Sequence[int],
    surfaces: list[GeomSurface],
    layout: SoleLayout | SkinPatch,
    radius: float,
    region: Region,
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
) -> tuple[Any, ...]:
    rows = np.full(model.ngeom, -1, dtype=np.int32)
    rows[list(geoms)] = np.arange(len(geoms))
    frames = np.array([[*((s.position - position) @ rotation), *(rotation.T @ s.rotation).ravel()] for s in surfaces])
    planes = [s.planes if s.kind == mujoco.mjtGeom.mjGEOM_MESH else np.zeros((0, 4)) for s in surfaces]
    starts = np.cumsum([0, *(len(p) for p in planes)]).astype(np.int32)
    limits = np.zeros(14)
    limits[3] = -2.0
    limits[7] = 2.0
    if region.outward is not None:
        limits[:4] = [*(region.outward @ rotation), math.cos(region.within)]
    if region.axis is not None:
        limits[4:8] = [*(region.axis @ rotation), math.sqrt(0.5)]
    # The box's axes are the body's: its coordinates of a place in the patch's frame.
    limits[8:11] = region.low - position
    limits[11:14] = region.high - position
    return (
        np.ascontiguousarray(layout.positions),
        np.ascontiguousarray(layout.rotations[:, :, 2]),
        np.ascontiguousarray(layout.areas),
        radius,
        rows,
        np.array([s.kind for s in surfaces], dtype=np.int32),
        frames,
        np.array([s.size for s in surfaces]),
        starts,
        np.ascontiguousarray(np.vstack(planes)),
        limits,
        region.outline,
        np.ascontiguousarray(rotation),
    )
