"""The surface of a model's bodies as triangles, where the model's state has them."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

__all__ = ["convex_surface", "geom_triangles", "shapes_of"]

_AROUND, _ALONG = 32, 8  # of a round shape
_BOX = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])

Triangles = NDArray[np.float64]


def shapes_of(model: Any, bodies: Collection[int]) -> tuple[list[int], list[int]]:
    """Geoms of some bodies.

    Args:
        model: The model.
        bodies: Ids of the bodies.

    Returns:
        Ids of those that are only drawn, and of those that collide; planes are neither.
    """
    drawn: list[int] = []
    colliding: list[int] = []
    for i in range(model.ngeom):
        if int(model.geom_bodyid[i]) in bodies and model.geom_type[i] != mujoco.mjtGeom.mjGEOM_PLANE:
            touches = bool(model.geom_contype[i] or model.geom_conaffinity[i])
            (colliding if touches else drawn).append(i)
    return drawn, colliding


def geom_triangles(model: Any, data: Any, geom: int) -> Triangles:
    """Triangles (n, 3, 3) of a geom in the world in m.

    Args:
        model: The model.
        data: Its state, with kinematics.
        geom: Id of the geom.

    Returns:
        The triangles; round shapes are faceted.
    """
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
        local = model.mesh_vert[first : first + count][model.mesh_face[face : face + faces]].astype(float)
    else:
        local = convex_surface(_points_of(kind, size))
    rotation = data.geom_xmat[geom].reshape(3, 3)
    return np.asarray(local @ rotation.T + data.geom_xpos[geom])


def convex_surface(points: NDArray[np.float64]) -> Triangles:
    """Triangles (n, 3, 3) of the convex hull of points (m, 3), outward counter-clockwise; none where they are flat."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return np.zeros((0, 3, 3))
    triangles = points[hull.simplices]
    cross = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    inward = np.einsum("ij,ij->i", cross, hull.equations[:, :3]) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return np.asarray(triangles)


def _points_of(kind: int, size: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points whose hull is a shape of MuJoCo's about the origin, its axis along z."""
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
