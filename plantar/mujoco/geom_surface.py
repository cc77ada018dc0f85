"""The surface of each convex geom of a body: where lines cross it, what is inside, its flat faces."""

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.mujoco.mesh_surface import mesh_surface

_KINDS = mujoco.mjtGeom
_ROUND = (_KINDS.mjGEOM_SPHERE, _KINDS.mjGEOM_ELLIPSOID, _KINDS.mjGEOM_CAPSULE)
_RIM = 96  # corners of a cylinder's cap, where it is drawn as a polygon: 0.07 % of its area are missing
_SAME = 1e-6  # m, or of a normal's components: float32 corners of a mesh lie so near the plane of their face


class GeomSurface:
    """A geom's surface in the frame of its body.

    Attributes:
        kind: As MuJoCo numbers it.
        size: Sizes (3,) as MuJoCo has them.
        position: Of its frame (3,) in the body's in m.
        rotation: Of its frame (3, 3) to the body's.
        planes: Outward normal and offset (p, 4) of the faces of a box or a mesh's hull, in its frame; else empty.
        corners: Corners (c, 3) of a box or hull in its frame; else empty.
    """

    def __init__(self, model: Any, data: Any, geom: int, place: NDArray[np.float64], turn: NDArray[np.float64]) -> None:
        self.kind = int(model.geom_type[geom])
        self.size = np.array(model.geom_size[geom])
        self.position = turn.T @ (data.geom_xpos[geom] - place)
        self.rotation = turn.T @ data.geom_xmat[geom].reshape(3, 3)
        self.planes = np.zeros((0, 4))
        self.corners = np.zeros((0, 3))
        if self.kind == _KINDS.mjGEOM_BOX:
            sides = np.vstack([np.eye(3), -np.eye(3)])
            self.planes = np.column_stack([sides, np.tile(self.size, 2)])
            self.corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * self.size
        elif self.kind == _KINDS.mjGEOM_MESH:
            self.planes, self.corners = _hull(model, int(model.geom_dataid[geom]))
        elif self.kind not in (*_ROUND, _KINDS.mjGEOM_CYLINDER):
            name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom) or geom
            raise RobotError(
                f"geom {name} is a plane, height field or signed distance field; "
                "allowed: spheres, capsules, ellipsoids, cylinders, boxes and meshes"
            )

    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest corner (3,) of a box about it, body frame."""
        if len(self.corners):
            seen = self.corners @ self.rotation.T + self.position
            return seen.min(axis=0), seen.max(axis=0)
        half = self.size.copy()
        if self.kind == _KINDS.mjGEOM_SPHERE:
            half[:] = half[0]
        elif self.kind != _KINDS.mjGEOM_ELLIPSOID:
            extra = self.size[0] if self.kind == _KINDS.mjGEOM_CAPSULE else 0.0
            half = np.array([self.size[0], self.size[0], self.size[1] + extra])
        wide = np.abs(self.rotation) @ half
        return self.position - wide, self.position + wide

    def contains(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether points (n, 3), body frame, lie inside by more than a micrometre."""
        p = (points - self.position) @ self.rotation
        if len(self.planes):
            return np.asarray((p @ self.planes[:, :3].T < self.planes[:, 3] - _SAME).all(axis=1))
        if self.kind == _KINDS.mjGEOM_CYLINDER:
            return np.asarray(
                (np.hypot(p[:, 0], p[:, 1]) < self.size[0] - _SAME) & (np.abs(p[:, 2]) < self.size[1] - _SAME)
            )
        if self.kind == _KINDS.mjGEOM_ELLIPSOID:
            return np.asarray(np.linalg.norm(p / (self.size - _SAME), axis=1) < 1.0)
        return np.asarray(np.linalg.norm(p - self._spine(p), axis=1) < self.size[0] - _SAME)

    def crossings(
        self, starts: NDArray[np.float64], way: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Where lines cross it: line numbers (m,), points (m, 3) and outward normals (m, 3), body frame.

        `starts` (n, 3) in m; `way`: their common unit vector (3,).
        """
        o = (starts - self.position) @ self.rotation
        d = way @ self.rotation
        near, far = self._spans(o, d)
        lines = np.flatnonzero(far > near)
        both = np.concatenate([lines, lines])
        local = o[both] + np.concatenate([near[lines], far[lines]])[:, None] * d
        order = np.argsort(both, kind="stable")  # line by line, along each
        local = local[order]
        return both[order], local @ self.rotation.T + self.position, self._normals(local) @ self.rotation.T

    def faces(self) -> list[NDArray[np.float64]]:
        """Corners (k, 3) of its flat faces, body frame, counter-clockwise from outside."""
        rings = []
        if self.kind == _KINDS.mjGEOM_CYLINDER:
            a = np.linspace(0.0, 2.0 * math.pi, _RIM, endpoint=False)
            rim = self.size[0] * np.column_stack([np.cos(a), np.sin(a)])
            rings = [np.column_stack([rim[::s], np.full(_RIM, s * self.size[1])]) for s in (-1, 1)]
        for *normal, offset in self.planes.tolist():
            on = self.corners[np.abs(self.corners @ normal - offset) < 2.0 * _SAME]
            middle = on.mean(axis=0)
            first = on[0] - middle
            second = np.cross(normal, first)
            turns = np.arctan2((on - middle) @ second, (on - middle) @ first)
            rings.append(on[np.argsort(turns)])
        return [ring @ self.rotation.T + self.position for ring in rings]

    def _spine(self, p: NDArray[np.float64]) -> NDArray[np.float64]:
        """Nearest points (n, 3) on a sphere's or capsule's axis, its frame."""
        half = self.size[1] if self.kind == _KINDS.mjGEOM_CAPSULE else 0.0
        return np.column_stack([np.zeros((len(p), 2)), np.clip(p[:, 2], -half, half)])

    def _spans(self, o: NDArray[np.float64], d: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """How far along each line it begins and ends; the end before the begin for a miss."""
        if len(self.planes):
            return _between(o, d, self.planes)
        if self.kind == _KINDS.mjGEOM_ELLIPSOID:
            return _quadratic(o / self.size, d / self.size, 1.0)
        if self.kind == _KINDS.mjGEOM_CYLINDER:
            near, far = _quadratic(o[:, :2], d[:2], self.size[0])
            caps = np.array([[0.0, 0.0, 1.0, self.size[1]], [0.0, 0.0, -1.0, self.size[1]]])
            low, high = _between(o, d, caps)
            return np.maximum(near, low), np.minimum(far, high)
        if self.kind == _KINDS.mjGEOM_SPHERE:
            return _quadratic(o, d, self.size[0])
        near = np.full(len(o), math.inf)
        far = np.full(len(o), -math.inf)
        for shift in (-self.size[1], self.size[1]):
            low, high = _quadratic(o - [0.0, 0.0, shift], d, self.size[0])
            near = np.where(high > low, np.minimum(near, low), near)
            far = np.where(high > low, np.maximum(far, high), far)
        low, high = _quadratic(o[:, :2], d[:2], self.size[0])
        for t in (low, high):
            with np.errstate(invalid="ignore"):
                on = (high > low) & np.isfinite(t) & (np.abs(o[:, 2] + t * d[2]) <= self.size[1])
            near = np.where(on, np.minimum(near, t), near)
            far = np.where(on, np.maximum(far, t), far)
        return near, far

    def _normals(self, p: NDArray[np.float64]) -> NDArray[np.float64]:
        """Outward normals (n, 3) at points (n, 3) of the surface, its frame."""
        if len(self.planes):
            faces = np.argmax(p @ self.planes[:, :3].T - self.planes[:, 3], axis=1)
            return np.asarray(self.planes[faces, :3])
        if self.kind == _KINDS.mjGEOM_CYLINDER:
            wide = np.hypot(p[:, 0], p[:, 1])
            side = np.column_stack([p[:, :2] / np.maximum(wide, 1e-12)[:, None], np.zeros(len(p))])
            cap = np.column_stack([np.zeros((len(p), 2)), np.sign(p[:, 2])])
            return np.asarray(np.where((wide - self.size[0] > np.abs(p[:, 2]) - self.size[1])[:, None], side, cap))
        out = p / self.size**2 if self.kind == _KINDS.mjGEOM_ELLIPSOID else p - self._spine(p)
        return np.asarray(out / np.linalg.norm(out, axis=1)[:, None])


def body_surfaces(model: Any, body: int, geoms: Sequence[int]) -> list[GeomSurface]:
    """The surfaces of a `model`'s `geoms` in the frame of a `body`, all of them ids."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    place = data.xpos[body].copy()
    turn = data.xmat[body].reshape(3, 3).copy()
    return [GeomSurface(model, data, g, place, turn) for g in geoms]


def _between(
    o: NDArray[np.float64], d: NDArray[np.float64], planes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    near = np.full(len(o), -math.inf)
    far = np.full(len(o), math.inf)
    for plane in planes:
        slope = float(plane[:3] @ d)
        left = plane[3] - o @ plane[:3]
        if abs(slope) < 1e-12:
            near = np.where(left < 0.0, math.inf, near)
        elif slope > 0.0:
            far = np.minimum(far, left / slope)
        else:
            near = np.maximum(near, left / slope)
    return near, far


def _quadratic(
    o: NDArray[np.float64], d: NDArray[np.float64], radius: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where |o + t d| = radius."""
    a = float(d @ d)
    c = np.einsum("ij,ij->i", o, o) - radius * radius
    if a < 1e-18:
        return np.where(c < 0.0, -math.inf, math.inf), np.where(c < 0.0, math.inf, -math.inf)
    b = o @ d
    root = b * b - a * c
    hit = root > 0.0
    width = np.sqrt(np.where(hit, root, 0.0))
    return np.where(hit, (-b - width) / a, math.inf), np.where(hit, (-b + width) / a, -math.inf)


def _hull(model: Any, mesh: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Planes (p, 4) and corners (c, 3) of a mesh's convex hull: what MuJoCo collides."""
    from scipy.spatial import ConvexHull, QhullError

    corners = mesh_surface(model, mesh)[0]
    start = int(model.mesh_graphadr[mesh])
    if start >= 0:  # the hull's own corners, of which there may be fewer by `maxhullvert`
        count = int(model.mesh_graph[start])
        corners = corners[model.mesh_graph[start + 2 + count : start + 2 + 2 * count]]
    try:
        hull = ConvexHull(corners)
    except QhullError:
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_MESH, mesh) or mesh
        raise RobotError(f"mesh {name} has no inside; allowed: meshes that enclose a volume") from None
    planes = np.column_stack([hull.equations[:, :3], -hull.equations[:, 3]])
    kept: list[NDArray[np.float64]] = []
    for plane in planes[np.lexsort(np.round(planes, 6).T)]:
        if not any(np.abs(plane - other).max() < 10.0 * _SAME for other in kept[-8:]):
            kept.append(plane)
    return np.array(kept), np.asarray(corners[hull.vertices])
