"""Face and outline of a body's sole, from its collision geoms."""

import math
from collections.abc import Collection
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.sides import Side
from plantar.errors import RobotError
from plantar.mujoco.mesh_surface import mesh_surface

_DEPTH = 0.01  # m above the lowest point: what of a round sole a load brings to the ground
_TILT = math.cos(math.radians(35.0))  # a face that is turned farther from down is no sole
_LEANT = math.cos(math.radians(60.0))  # a face that is turned farther is a side of what lies, as a cylinder's cap
_LEVEL = math.cos(math.radians(3.0))
_LEAST_FACE = 0.3  # of the sole's outline: a smaller face is a facet of something round


class SoleShape(NamedTuple):
    """A sole, in the frame of its body.

    `position`: sole origin (3,): the body's projected onto the face; `rotation`: rotation (3, 3) from sole to body;
    columns forward, left, into body; `outline`: convex outline (k, 2) in sole frame, counter-clockwise; `side`: "left"
    where the body is left of its robot's root, along x in reference pose, else "right"; `is_flat`: whether the geoms
    have a face; else the sole is round.
    """

    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    outline: NDArray[np.float64]
    side: Side
    is_flat: bool


def rigid_geoms(model: Any, body: int) -> list[int]:
    """Returns ids of a `model`'s geoms that can collide, of `body` (an id) and parts fixed to it."""
    fixed = {body}
    for child in range(body + 1, model.nbody):
        if model.body_jntnum[child] == 0 and int(model.body_parentid[child]) in fixed and body != 0:
            fixed.add(child)
    paired = {int(g) for pair in (model.pair_geom1, model.pair_geom2) for g in pair}
    return [
        g
        for g in range(model.ngeom)
        if int(model.geom_bodyid[g]) in fixed and (model.geom_contype[g] or model.geom_conaffinity[g] or g in paired)
    ]


def sole_shape(
    model: Any,
    body: int,
    geoms: Collection[int],
    outward: ArrayLike | None = None,
    forward: ArrayLike | None = None,
) -> SoleShape:
    """Find a body's sole: its geoms' lowest face in the reference pose.

    `model`: MjModel; its reference pose is the first keyframe, or else `qpos0`; `outward`: direction (3,) of sole, body
    frame; None for gravity's; `forward`: forward (3,), body frame; None for the body's axis that is nearest the world's
    x where the sole lies across a body's axis, as feet's do, else the world's x.
    """
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_kinematics(model, data)
    place = data.xpos[body].copy()
    turn = data.xmat[body].reshape(3, 3).copy()
    parts = [_surface(model, data, g, place, turn) for g in geoms]
    gravity = model.opt.gravity if np.linalg.norm(model.opt.gravity) > 1e-6 else np.array([0.0, 0.0, -1.0])
    down = unit_vector(turn.T @ gravity if outward is None else outward, "outward")
    sought = down
    down, is_flat = _face(parts, down)
    if not is_flat:
        _refuse_edge(parts, sought, model.body(body).name)
    ahead = _ahead(turn, down) if forward is None else unit_vector(forward, "forward")
    if abs(ahead @ down) > 0.95:
        if forward is not None:
            raise RobotError("the sole faces the way that is given as forward; give forward=(x, y, z) along the sole")
        ahead = turn.T @ np.array([0.0, 0.0, 1.0])
    rotation = axes_facing(down, ahead)
    lowest = max(float((p.points @ down).max()) for p in parts)
    position = lowest * down
    outline = _outline(parts, position, rotation)
    root = int(model.body_rootid[body])
    aside = float((turn @ rotation[:, 1]) @ (place - data.xpos[root if root != body else 0]))
    return SoleShape(position, rotation, outline, "left" if aside > -1e-9 else "right", is_flat)


def axes_facing(out: NDArray[np.float64], ahead: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) of a skin's frame that faces `out` (3,): z against it, x as near `ahead` (3,) as can be."""
    x = ahead - (ahead @ out) * out
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(-out, x), -out])


def _ahead(turn: NDArray[np.float64], down: NDArray[np.float64]) -> NDArray[np.float64]:
    """Forward (3,) of a sole that faces `down` (3,), body frame: a body's own axis if the sole lies across one."""
    ahead: NDArray[np.float64] = turn.T @ np.array([1.0, 0.0, 0.0])
    across = int(np.argmax(np.abs(down)))
    if abs(down[across]) < _LEVEL:
        return ahead
    own = np.where(np.arange(3) == across, 0.0, ahead)
    nearest = int(np.argmax(np.abs(own)))
    return np.asarray(math.copysign(1.0, own[nearest]) * np.eye(3)[nearest] if own.any() else ahead)


class _Part(NamedTuple):
    """Points (m, 3) on a geom's surface, body frame; a round one's radius and centers (c, 3)."""

    points: NDArray[np.float64]
    centres: NDArray[np.float64] | None = None
    radius: float = 0.0


def _surface(model: Any, data: Any, geom: int, place: NDArray[np.float64], turn: NDArray[np.float64]) -> _Part:
    kind = int(model.geom_type[geom])
    size = model.geom_size[geom]
    kinds = mujoco.mjtGeom
    centres = None
    if kind == kinds.mjGEOM_MESH or kind == kinds.mjGEOM_SDF:
        local = mesh_surface(model, int(model.geom_dataid[geom]))[0]
    elif kind == kinds.mjGEOM_BOX:
        local = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
    elif kind == kinds.mjGEOM_CYLINDER:
        a = np.linspace(0.0, 2.0 * math.pi, 48, endpoint=False)
        rim = np.column_stack([size[0] * np.cos(a), size[0] * np.sin(a)])
        local = np.vstack([np.column_stack([rim, np.full(48, z)]) for z in (-size[1], size[1])])
    elif kind in (kinds.mjGEOM_SPHERE, kinds.mjGEOM_ELLIPSOID, kinds.mjGEOM_CAPSULE):
        ball = _ball()
        if kind == kinds.mjGEOM_ELLIPSOID:
            local = ball * size
        else:
            half = size[1] if kind == kinds.mjGEOM_CAPSULE else 0.0
            centres = np.array([[0.0, 0.0, -half], [0.0, 0.0, half]] if half else [[0.0, 0.0, 0.0]])
            local = np.vstack([c + size[0] * ball for c in centres])
    else:
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or geom
        raise RobotError(f"geom {name} of the sole is a plane or height field; allowed: shapes with an inside")
    to_body = turn.T @ data.geom_xmat[geom].reshape(3, 3)
    shift = turn.T @ (data.geom_xpos[geom] - place)
    seen = local @ to_body.T + shift
    return _Part(seen) if centres is None else _Part(seen, centres @ to_body.T + shift, float(size[0]))


def _ball() -> NDArray[np.float64]:
    """Points (400, 3) evenly over the unit sphere."""
    i = np.arange(400) + 0.5
    height = 1.0 - i / 200.0
    angle = math.pi * (1.0 + math.sqrt(5.0)) * i
    ring = np.sqrt(1.0 - height**2)
    return np.column_stack([ring * np.cos(angle), ring * np.sin(angle), height])


def _face(parts: list[_Part], down: NDArray[np.float64]) -> tuple[NDArray[np.float64], bool]:
    """Normal (3,) of the large face nearest a direction, and whether there is one."""
    from scipy.spatial import ConvexHull, QhullError

    start = down
    found = False
    for _ in range(4):
        # Points in which a face can lie: corners, or the lowest of something round.
        corners = np.vstack([p.points if p.centres is None else p.centres + p.radius * down for p in parts])
        extent = float(np.ptp(corners, axis=0).max())
        # A roof makes a flat set of points solid; no face that leans on it looks down.
        roof = corners.mean(axis=0) - down * max(extent, 0.05)
        try:
            hull = ConvexHull(np.vstack([corners, roof]))
        except QhullError:
            return start, False
        normals = hull.equations[:, :3]
        faces = []
        for normal in normals[normals @ start > _TILT]:
            faces.append((_face_area(hull, normal), tuple(normal)))
        if not faces:
            return start, False
        area, normal = max(faces)
        seen = np.vstack([p.points for p in parts])
        across = seen - np.outer(seen @ start, start)
        if area < _LEAST_FACE * _area_across(across[(seen @ start) > (seen @ start).max() - _DEPTH], start):
            return start, False
        found = True
        if np.allclose(normal, down, atol=1e-12):
            break
        down = np.array(normal)
        if all(p.centres is None for p in parts):
            break
    return down / np.linalg.norm(down), found


def _refuse_edge(parts: list[_Part], down: NDArray[np.float64], name: str) -> None:
    """Refuse a body whose lowest geom has a large face that is turned too far from down: it is on an edge of it."""
    from scipy.spatial import ConvexHull, QhullError

    lowest = max(parts, key=lambda p: float((p.points @ down).max()))
    if lowest.centres is not None:
        return
    try:
        hull = ConvexHull(lowest.points)
    except QhullError:
        return
    heights = hull.points @ down
    low = heights > heights.max() - 1e-3 * float(np.ptp(hull.points, axis=0).max())
    normals = hull.equations[:, :3]
    for normal in normals[low[hull.simplices].any(axis=1) & (normals @ down > _LEANT)]:
        if _face_area(hull, normal) > _LEAST_FACE * _area_across(hull.points, normal):
            angle = math.degrees(math.acos(min(1.0, float(normal @ down))))
            raise RobotError(
                f"body '{name}' is on an edge: its nearest face is turned by {angle:.0f} deg from where it looks; "
                "allowed: up to 35 deg; give outward=(x, y, z), or a keyframe in which it stands"
            )


def _face_area(hull: Any, normal: NDArray[np.float64]) -> float:
    """Area in m^2 of a convex hull's triangles that have a normal (3,)."""
    same = hull.equations[:, :3] @ normal > 1.0 - 1e-5
    a, b, c = (hull.points[hull.simplices[same, k]] for k in range(3))
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _area_across(points: NDArray[np.float64], axis: NDArray[np.float64]) -> float:
    """Hull area in m^2 of points projected along an axis."""
    import shapely

    first = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0])
    first /= np.linalg.norm(first)
    return float(shapely.MultiPoint(np.column_stack([points @ first, points @ np.cross(axis, first)])).convex_hull.area)


def _outline(parts: list[_Part], position: NDArray[np.float64], rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Hull (k, 2) of points within `_DEPTH` of the lowest, sole frame."""
    import shapely
    from scipy.spatial import ConvexHull, QhullError

    below = []
    for part in parts:
        local = (part.points - position) @ rotation
        below.append(local[local[:, 2] <= _DEPTH, :2])
        try:
            hull = ConvexHull(local)
        except QhullError:  # a flat mesh: its corners are all there is
            continue
        for a, b in ((0, 1), (1, 2), (2, 0)):
            first = local[hull.simplices[:, a]]
            second = local[hull.simplices[:, b]]
            cut = (first[:, 2] - _DEPTH) * (second[:, 2] - _DEPTH) < 0.0
            t = ((_DEPTH - first[cut, 2]) / (second[cut, 2] - first[cut, 2]))[:, None]
            below.append((first[cut] + t * (second[cut] - first[cut]))[:, :2])
    hull = shapely.MultiPoint(np.vstack(below)).convex_hull
    if hull.geom_type != "Polygon":
        raise RobotError("the lowest face of the sole's geoms has no area; check their sizes, or name geoms=[...]")
    return np.ascontiguousarray(shapely.get_coordinates(shapely.orient_polygons(hull))[:-1])


def unit_vector(given: ArrayLike, name: str) -> NDArray[np.float64]:
    """Direction (3,) of length 1 of an argument called `name`; RobotError if it has none."""
    try:
        vector = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        vector = np.zeros(0)
    length = float(np.linalg.norm(vector)) if vector.shape == (3,) else math.nan
    if not (math.isfinite(length) and length > 1e-9):
        raise RobotError(f"direction '{name}' is {given!s:.60}; expected three numbers, not all 0")
    return vector / length
