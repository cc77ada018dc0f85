"""The surface of a model's bodies as triangles."""

import math
from collections.abc import Collection, Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from plantar.geometry.hull_plane import hull_plane
from plantar.mujoco.mesh_surface import mesh_surface

# of a round shape
_AROUND = 32
_ALONG = 8
# of the largest shape's size: smaller drawn shapes, and smaller balls, mark a place
_MARKER = 0.02
_BALL = 0.5
_PLANE = mujoco.mjtGeom.mjGEOM_PLANE
_SPHERE = mujoco.mjtGeom.mjGEOM_SPHERE
_STEEPEST = math.cos(math.radians(45.0))  # of a plane to rest on
# of the hull that are looked at for it
_SAME_PLANE = math.cos(math.radians(1.0))
_FACES = 24
_BOX = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])

SHAPES: Mapping[Any, tuple[str, int]] = {
    mujoco.mjtGeom.mjGEOM_SPHERE: ("sphere", 1),
    mujoco.mjtGeom.mjGEOM_CAPSULE: ("capsule", 2),
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: ("ellipsoid", 3),
    mujoco.mjtGeom.mjGEOM_CYLINDER: ("cylinder", 2),
    mujoco.mjtGeom.mjGEOM_BOX: ("box", 3),
}
"""Word in MJCF of each of MuJoCo's simple shapes, and how many numbers its size has."""

Triangles = NDArray[np.float64]


def shapes_of(model: Any, bodies: Collection[int]) -> tuple[list[int], list[int]]:
    """Ids of drawn geoms of `bodies` of a `model`, without markers, and of colliding ones.

    Returns both lists.
    """
    shapes = [i for i in range(model.ngeom) if int(model.geom_bodyid[i]) in bodies and model.geom_type[i] != _PLANE]
    size = {i: float(model.geom_rbound[i]) for i in shapes}
    largest = max(size.values(), default=0.0)
    colliding = [i for i in shapes if model.geom_contype[i] or model.geom_conaffinity[i]]
    round_only = all(model.geom_type[i] == _SPHERE for i in shapes)
    least = {i: largest * (_BALL if model.geom_type[i] == _SPHERE and not round_only else _MARKER) for i in shapes}
    drawn = [i for i in shapes if i not in colliding and model.geom_rgba[i, 3] > 0.0 and size[i] > least[i]]
    return drawn, colliding


def geom_triangles(model: Any, data: Any, geom: int) -> Triangles:
    """Returns triangles (n, 3, 3) of a `geom` in the world in m, of `model` and `data`."""
    kind = int(model.geom_type[geom])
    size = model.geom_size[geom]
    turn = data.geom_xmat[geom].reshape(3, 3).T
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        corners, faces = mesh_surface(model, int(model.geom_dataid[geom]))
        return np.asarray((corners @ turn + data.geom_xpos[geom])[faces])  # a corner is of six triangles
    return np.asarray(convex_surface(_points_of(kind, size)) @ turn + data.geom_xpos[geom])


def convex_surface(points: NDArray[np.float64]) -> Triangles:
    """Hull triangles (n, 3, 3) of points (m, 3), counter-clockwise from outside; none if flat."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return np.zeros((0, 3, 3))
    triangles = points[hull.simplices]
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    inward = np.einsum("ij,ij->i", cross, hull.equations[:, :3]) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return np.asarray(triangles)


def resting_plane(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The plane on which surface points (n, 3), z up, would rest.

    Returns outward normal (3,) of the largest lower plane of their convex hull, and its area over the silhouette's from
    above: straight down and 0 without one within 45 degrees.
    """
    normal, area = hull_plane(points, -_STEEPEST, _SAME_PLANE, _FACES)
    return normal, area / ConvexHull(points[:, :2]).volume if area > 0.0 else 0.0


def _points_of(kind: int, size: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points with a MuJoCo shape's hull, its axis along z."""
    types = mujoco.mjtGeom
    if kind == types.mjGEOM_BOX:
        return _BOX * size
    around = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    circle = np.stack([np.cos(around), np.sin(around), np.zeros(_AROUND)], axis=1)
    if kind == types.mjGEOM_CYLINDER:
        ring = circle * (size[0], size[0], 0.0)
        rise = np.array([0.0, 0.0, float(size[1])])
        return np.concatenate([ring + rise, ring - rise])
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * _ALONG + 1).tolist()
    ball = np.concatenate([circle * np.cos(a) + np.array([0.0, 0.0, np.sin(a)]) for a in angles])
    if kind == types.mjGEOM_ELLIPSOID:
        return np.asarray(ball * size)
    ball = ball * size[0]
    if kind == types.mjGEOM_CAPSULE:
        top = np.array([0.0, 0.0, float(size[1])])
        return np.concatenate([ball + top, ball - top])
    return np.asarray(ball)
